"""Contact points in isolation: gradients, tangents, loss, stick and slip, roads of every kind."""

import numpy as np
import pytest

from mbs.common.errors import ModelError
from mbs.elements import ContactPoints, EndStops, GridRoad, KerbRoad, PlaneRoad, SpringDamper
from tests.elements.harness import Element, frame, tangent_by_differences, vectors

CONTACT = ContactPoints(2e5, 2e5, 1e4, onset=0.005, loss=0.5, friction_factor=0.5)
POINTS = np.array([[0.1, 0.2, -0.3], [-0.2, 0.1, -0.25], [0.0, 0.0, 0.3]])
X = np.linspace(-3.0, 3.0, 25)
ROADS = {
    "plane": PlaneRoad(0.1, 0.1, -0.2, 0.8),
    "kerb": KerbRoad(0.0, 0.2, -0.1, "before", 0.8),
    "kerb up": KerbRoad(0.0, 0.2, -0.1, "after", 0.8),
    "grid": GridRoad((-3.0, -3.0), (0.25, 0.25), 0.1 * np.sin(X)[:, None] + 0.05 * np.cos(2.0 * X)[None, :], 0.8),
}


def element(road=ROADS["plane"], contact=CONTACT, points=POINTS):
    o, x, y, z = vectors(3, 3, 3, 3)
    return Element(contact.record("feet", o, (x, y, z), points, 0), road)


def pose(rng, height, tilt=0.1):
    R = np.eye(3) + tilt * (frame(rng) - np.eye(3))
    Q, _ = np.linalg.qr(R)
    Q = Q * np.sign(np.diag(Q))
    return np.r_[rng.uniform(-0.3, 0.3, 2), height, Q.T.ravel()]


def friction(f):
    return ContactPoints(2e5, 2e5, 1e4, loss=f.get("loss", 0.0), friction_factor=f.get("factor", 0.0))


@pytest.mark.parametrize(("name", "radius"), [("plane", 0.0), ("kerb", 0.0), ("kerb up", 0.03), ("grid", 0.03)])
def test_normal_force_is_the_gradient_of_its_potential(name, radius):
    e = element(ROADS[name], ContactPoints(2e5, 2e5, 1e4, friction_factor=0.0, radius=radius))
    rng, touched = np.random.default_rng(3), 0
    for _ in range(40):
        u = pose(rng, rng.uniform(0.1, 0.45))
        r = e(u, np.zeros(12), h=0.0)
        slope = [(e(u + 1e-6 * d, np.zeros(12)).potential - e(u - 1e-6 * d, np.zeros(12)).potential) / 2e-6
                 for d in np.eye(12)]  # fmt: skip
        # of a sphere the point is displaced, of a grid the foot is found in three passes
        assert np.allclose(r.f, -np.array(slope), atol=2e-3 * max(1.0, np.abs(r.f).max()))
        touched += r.out["touching"] > 0
    assert touched > 13


@pytest.mark.parametrize("sticks", [True, False])
@pytest.mark.parametrize("restitution", [0.0, 0.25])
def test_tangent_on_a_plane(sticks, restitution):
    law = ContactPoints(2e5, 2e5, 1e4, loss=5.0, friction_factor=50.0 * sticks, restitution=restitution)
    e = element(PlaneRoad(0.0, 0.0, 0.0, 0.8), law)
    rng = np.random.default_rng(4)
    for _ in range(10):
        u, ud = pose(rng, 0.28), 0.05 * rng.normal(size=12)
        r = e(u, ud, None, 0.01, 0.005, 2.5e-5)
        expected = tangent_by_differences(e, u, ud, None, 0.01, 0.005, 2.5e-5, ())
        assert r.out["touching"] > 0
        # friction's dependence on the axes of the body is left out
        assert np.max(np.abs(r.S - expected)[:3, :3]) < 2e-6 * max(1.0, np.abs(expected).max())
        assert np.linalg.eigvalsh(r.S).min() > -1e-9 * np.abs(r.S).max()


def test_force_equals_the_law_and_is_held_by_friction():
    e = element(PlaneRoad(0.0, 0.0, 0.0, 0.8), points=[[0.0, 0.0, 0.0]])
    for depth, normal_force in ((0.002, 2e5 * 0.002**2 / 0.01), (0.012, 2e5 * (0.012 - 0.0025))):
        u = np.r_[0.0, 0.0, -depth, np.eye(3).ravel()]
        r = e(u, np.zeros(12))
        assert r.out["normal_force"] == pytest.approx(normal_force, rel=1e-12)
        assert r.out["depth"] == pytest.approx(depth)
        assert np.allclose(r.f[:3], [0.0, 0.0, normal_force])
        slide = e(u, np.r_[3.0, 4.0, np.zeros(10)], h=0.01)
        bound = 0.4 * slide.out["normal_force"]
        assert np.allclose(slide.f[:2], [-0.6 * bound, -0.8 * bound])
        stick = e(u, np.r_[1e-4, np.zeros(11)], h=0.01)
        assert stick.f[0] == pytest.approx(-(1e4 + 0.005 * 2e5) * 1e-4)


def test_what_sticks_is_a_spring_and_a_damper():
    """The force is k z + c z' of the deflection and its rate, and z' is the velocity; both at the end of the step."""
    e = element(PlaneRoad(0.0, 0.0, 0.0, 0.8), points=[[0.0, 0.0, 0.0]])
    u, v, h = np.r_[0.0, 0.0, -0.012, np.eye(3).ravel()], 1e-4, 0.01
    y = np.array([2e-5, -1e-5, 3e-3, 1e-3])
    r = e(u, np.r_[v, 0.0, np.zeros(10)], y, h)
    np.testing.assert_allclose(-r.f[:2], 2e5 * r.y[:2] + 1e4 * r.y[2:], rtol=1e-12)
    np.testing.assert_allclose(r.y[2:], [v, 0.0], atol=1e-15)
    np.testing.assert_allclose(r.y[:2], y[:2] + 0.5 * h * (y[2:] + r.y[2:]), rtol=1e-12)


def test_friction_never_gives_energy():
    e = element(PlaneRoad(0.0, 0.0, 0.0, 0.8), points=[[0.0, 0.0, 0.0]])
    rng, y, taken = np.random.default_rng(5), np.zeros(4), 0.0
    u = np.r_[0.0, 0.0, -0.01, np.eye(3).ravel()]
    h = 0.002
    for k in range(400):
        v = 0.5 * np.sin([0.1 * k, 0.17 * k]) * rng.uniform(0.5, 1.5)
        r = e(u, np.r_[v, np.zeros(10)], y, h)
        slip = v - r.y[2:]  # of the slider
        assert r.f[:2] @ slip <= 1e-9
        taken += h * r.f[:2] @ (-v)
        y = r.y
    assert taken > 0.0


def test_pressing_loses_and_letting_go_does_not_pull():
    e = element(PlaneRoad(0.0, 0.0, 0.0, 0.8), ContactPoints(2e5, 2e5, 1e4, loss=2.0), [[0.0, 0.0, 0.0]])
    u = np.r_[0.0, 0.0, -0.01, np.eye(3).ravel()]
    still = e(u, np.zeros(12)).out["normal_force"]
    for v in (0.1, 1.0, 100.0):
        down, up = (e(u, np.r_[0.0, 0.0, s * v, np.zeros(9)]).out["normal_force"] for s in (-1.0, 1.0))
        assert down == pytest.approx(still * (1.0 + 2.0 * v))
        assert up == pytest.approx(still / (1.0 + 2.0 * v))


def test_a_least_restitution_bounds_the_loss():
    law = ContactPoints(2e5, 2e5, 1e4, loss=2.0, restitution=0.25)
    e = element(PlaneRoad(0.0, 0.0, 0.0, 0.8), law, [[0.0, 0.0, 0.0]])
    u = np.r_[0.0, 0.0, -0.01, np.eye(3).ravel()]
    still = e(u, np.zeros(12)).out["normal_force"]
    for v in (0.1, 1.0, 1e9):
        factor = 1.0 + 2.0 * v / (1.0 + 2.0 * v / 3.0)
        down, up = (e(u, np.r_[0.0, 0.0, s * v, np.zeros(9)]).out["normal_force"] for s in (-1.0, 1.0))
        assert (down / still, up / still) == pytest.approx((factor, 1.0 / factor))
    assert factor == pytest.approx(4.0)


def test_far_above_nothing_is_done_and_states_are_forgotten():
    e = element()
    r = e(np.r_[0.0, 0.0, 2.0, np.eye(3).ravel()], np.ones(12), np.ones(12), 0.01, 0.005, 2.5e-5)
    assert not np.any(r.f)
    assert not np.any(r.S)
    assert not np.any(r.y)
    assert not any(r.out.values())


@pytest.mark.parametrize("name", list(ROADS))
def test_the_cheap_look_never_misses_a_touch(name):
    road, rng = ROADS[name], np.random.default_rng(6)
    many, one = element(road), [element(road, points=[p]) for p in POINTS]
    for _ in range(300):
        u = np.r_[rng.uniform(-1.0, 1.0, 2), rng.uniform(-0.1, 0.6), frame(rng).T.ravel()]
        together = many(u, np.zeros(12)).out["touching"]
        # a single point has a box without size, and is looked at directly
        assert together == sum(e(u, np.zeros(12)).out["touching"] for e in one)


def test_the_cheap_look_knows_that_a_grid_swells_between_its_points():
    """Two points of 0.1 m beside two of 0: the surface between the two is 0.1125 m high."""
    heights = np.tile([0.0, 0.1, 0.1, 0.0], (4, 1)).T
    road = GridRoad((0.0, 0.0), (1.0, 1.0), heights, 0.8)
    low = element(road, points=[[0.0, 0.0, 0.0]])
    assert low(np.r_[1.5, 1.5, 0.107, np.eye(3).ravel()], np.zeros(12)).out["depth"] == pytest.approx(0.0055, abs=1e-4)


def test_kerb_lets_a_point_rest_on_its_top_and_stops_it_at_its_face():
    kerb = element(KerbRoad(0.0, 0.2, 0.0, "after", 0.8), ContactPoints(2e5, 2e5, 1e4), [[0.0, 0.0, 0.0]])

    def force(x, z):
        return kerb(np.r_[x, 0.0, z, np.eye(3).ravel()], np.zeros(12)).f[:3]

    assert np.allclose(force(0.5, 0.19), [0.0, 0.0, 2e5 * 0.0075], rtol=0.01, atol=60.0)
    face = force(0.01, 0.1)
    assert face[0] < -1000.0
    assert abs(face[2]) < 0.15 * -face[0]
    assert np.allclose(force(-0.5, -0.01), [0.0, 0.0, 2e5 * 0.0075])
    assert not np.any(force(-0.01, 0.1))


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: element(points=np.zeros((0, 3))), "points of shape"),
        (lambda: element(points=[[np.nan, 0.0, 0.0]]), "not finite"),
        (lambda: ContactPoints.for_mass(1.0, restitution=1.0), "restitution of contact points is 1.0; .* below 1"),
        (lambda: ContactPoints.for_mass(0.0), "mass of contact points is 0"),
    ],
)
def test_bad_data_is_named(make, message):
    with pytest.raises(ModelError, match=message):
        make()


STOPS = EndStops(
    0.6, 8e4, 0.9, 5e4, bump_progression=0.02, bump_travel=0.03, rebound_progression=0.03, rebound_travel=0.05,
    metal_stiffness=1e6, metal_onset=0.004, bump_loss=1.0, rebound_loss=0.3,
)  # fmt: skip


def progressive_stop():
    (d,) = vectors(3)
    return Element(SpringDamper(1e4, 0.0, 0.75, STOPS).record("spring", d))


@pytest.mark.parametrize("length", [0.54, 0.568, 0.58, 0.7, 0.93, 0.952, 0.97])
def test_progressive_stops_are_conservative_with_an_exact_tangent(length):
    e, n = progressive_stop(), np.array([0.6, 0.0, 0.8])
    r = e(length * n, np.zeros(3))
    slope = [(e(length * n + 1e-7 * d, np.zeros(3)).potential - e(length * n - 1e-7 * d, np.zeros(3)).potential) / 2e-7
             for d in np.eye(3)]  # fmt: skip
    assert np.allclose(r.f, -np.array(slope), rtol=1e-5, atol=0.05)
    x = max(0.6 - length, 0.0)
    metal = max(x - 0.03, 0.0)
    expected = 8e4 * x * (1.0 + (x / 0.02) ** 2) + 1e6 * (
        metal**2 / 0.008 if metal < 0.004 else max(metal - 0.002, 0.0)
    )
    y = max(length - 0.9, 0.0)
    far = max(y - 0.05, 0.0)
    pull = 5e4 * y * (1.0 + (y / 0.03) ** 2) + 1e6 * (far**2 / 0.008 if far < 0.004 else max(far - 0.002, 0.0))
    assert r.out["force"] == pytest.approx(1e4 * (length - 0.75) - expected + pull, rel=1e-9)
    rng = np.random.default_rng(7)
    for speed in (0.0, 0.5):
        ud = speed * rng.normal(size=3)
        S = e(length * n, ud, None, 0.01, 0.005, 2.5e-5).S
        wanted_S = tangent_by_differences(e, length * n, ud, None, 0.01, 0.005, 2.5e-5, (), 1e-7)
        assert np.max(np.abs(S - wanted_S)) < 1e-5 * max(1.0, np.abs(S).max())


def test_progressive_stops_lose_energy_and_never_pull():
    e, n = progressive_stop(), np.array([0.6, 0.0, 0.8])
    still = e(0.57 * n, np.zeros(3)).out["force"] - 1e4 * (0.57 - 0.75)
    for v in (0.3, 3.0, 30.0):
        closing, opening = (e(0.57 * n, s * v * n).out["force"] - 1e4 * (0.57 - 0.75) for s in (-1.0, 1.0))
        assert closing == pytest.approx(still * (1.0 + v))
        assert opening == pytest.approx(still / (1.0 + v))


def test_a_stop_without_stiffness_has_no_metal_end_either():
    (d,) = vectors(3)
    bump = EndStops(0.6, 8e4, bump_progression=0.02, metal_stiffness=1e6)
    e = Element(SpringDamper(0.0, 0.0, 0.75, bump).record("stop", d))
    assert not np.any(e(np.array([0.0, 0.0, 0.9]), np.ones(3)).f)
    assert e(np.array([0.0, 0.0, 0.55]), np.zeros(3)).out["force"] < -8e4 * 0.05


def wall(heading):
    """A point without friction at a wall of 1 m in a grid, and the direction into its face."""
    n = np.array([np.cos(heading), np.sin(heading)])
    x = np.arange(-3.0, 3.01, 0.1)
    heights = np.clip((np.add.outer(n[0] * x, n[1] * x) - 0.05) / 0.1, 0.0, 1.0)
    contact = ContactPoints(2e5, 2e5, 1e4, friction_factor=0.0)
    return element(GridRoad((-3.0, -3.0), (0.1, 0.1), heights, 0.8), contact, points=[[0.0, 0.0, 0.0]]), n


@pytest.mark.parametrize("heading", [0.0, 0.4])
def test_a_point_deep_in_a_wall_is_pushed_out_of_its_face(heading):
    """Not out of its top, which is farther: the force is that of the way to the face, the gradient of its energy."""
    e, n = wall(heading)
    axes = np.eye(3).ravel()
    for into in (0.12, 0.25, 0.35):
        o = np.r_[(0.1 + into) * n, 0.4]
        r = e(np.r_[o, axes], np.zeros(12), h=0.0)
        assert r.out["depth"] == pytest.approx(into, abs=0.03)  # heights on the grid make the face ragged
        assert r.f[:2] @ n < -0.8 * np.linalg.norm(r.f[:3])
        slope = [(e(np.r_[o + 1e-6 * d, axes], np.zeros(12)).potential
                  - e(np.r_[o - 1e-6 * d, axes], np.zeros(12)).potential) / 2e-6 for d in np.eye(3)]  # fmt: skip
        assert np.allclose(r.f[:3], -np.array(slope), atol=0.05 * np.linalg.norm(r.f[:3]))
    above = e(np.r_[1.5 * n, 0.9, axes], np.zeros(12), h=0.0)
    assert above.out["depth"] == pytest.approx(0.1)


def test_a_way_in_by_the_face_and_out_by_the_top_gains_nothing():
    """Work of the wall around a closed way, against the largest energy on it."""
    e, n = wall(0.4)
    corners = np.array([(-0.1, 0.6), (0.25, 0.6), (0.25, 1.05), (-0.1, 1.05)])
    work, most, steps = 0.0, 0.0, 400
    for begin, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        displacement = np.r_[(end[0] - begin[0]) * n, end[1] - begin[1]] / steps
        for k in range(steps):
            r = e(
                np.r_[begin[0] * n, begin[1], np.eye(3).ravel()] + (k + 0.5) * np.r_[displacement, np.zeros(9)],
                np.zeros(12),
            )
            work, most = work + r.f[:3] @ displacement, max(most, r.potential)
    assert most > 1e3
    assert abs(work) < 0.03 * most
