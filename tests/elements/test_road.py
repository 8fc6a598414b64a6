"""Where a disc touches plane, kerb and grid."""

import ctypes
import re

import numpy as np
import pytest

from mbs.elements import GridRoad, KerbRoad, PlaneRoad
from tests.elements.harness import Array, axis_of, contacts, library

RADIUS = 0.27
ROUND_OFF = 1e-12


def rim(centre: Array, axis: Array, radius: float, count: int = 20001) -> Array:
    """Points of a circle about the centre in the wheel plane, shape (count, 3)."""
    a = np.cross(axis, [0.0, 0.0, 1.0])
    a /= np.linalg.norm(a)
    b = np.cross(axis, a)
    t = np.linspace(0.0, 2.0 * np.pi, count)[:, None]
    return np.asarray(centre + radius * (np.cos(t) * a + np.sin(t) * b))


def test_plane_contact_is_the_lowest_point_of_the_disc_on_the_plane():
    road = PlaneRoad(0.1, 0.08, -0.05, 0.7)
    n = np.array([-0.08, 0.05, 1.0]) / np.linalg.norm([0.08, 0.05, 1.0])
    centre, axis = np.array([1.0, 2.0, 0.40]), axis_of(0.3, 0.1)
    (c,) = contacts(road, centre, axis, RADIUS)
    assert c["point"][2] == pytest.approx(0.1 + 0.08 * c["point"][0] - 0.05 * c["point"][1], abs=ROUND_OFF)
    assert (c["point"] - centre) @ axis == pytest.approx(0.0, abs=ROUND_OFF)
    assert np.allclose(c["normal"], n, atol=ROUND_OFF)
    lowest = min(rim(centre, axis, RADIUS - c["penetration"], 60001), key=lambda p: float(n @ p))
    assert np.allclose(lowest, c["point"], atol=1e-5)
    assert c["friction"] == 0.7


@pytest.mark.parametrize(
    ("yaw", "camber", "upper"), [(0.0, 0.0, "before"), (-0.3, 0.15, "before"), (0.2, -0.2, "after")]
)
def test_kerb_distance_is_that_of_the_nearest_point_of_the_solid_in_the_wheel_plane(yaw, camber, upper):
    road = KerbRoad(2.0, 0.08, 0.02, upper)  # type: ignore[arg-type]
    side, top = (1.0 if upper == "before" else -1.0), 0.10
    axis = axis_of(yaw, camber)
    kinds = set()
    for x in np.linspace(1.6, 2.4, 17):
        for height in (0.06, 0.12, 0.28):
            centre = np.array([x, 0.3, 0.02 + height])
            if side * (x - 2.0) <= 0.0 and centre[2] <= top + 0.02:
                continue  # the centre would be inside the step
            result = contacts(road, centre, axis, RADIUS)
            c, low = result
            assert low["point"][2] == pytest.approx(0.02, abs=ROUND_OFF)
            # along every ray of the wheel plane: where it enters the quarter space, if it does
            ray = rim(np.zeros(3), axis, 1.0)
            start, end = np.zeros(len(ray)), np.full(len(ray), np.inf)
            for height_now, speed in ((side * (x - 2.0), side * ray[:, 0]), (centre[2] - top, ray[:, 2])):
                speed = np.where(np.abs(speed) < 1e-12, 1e-12, speed)
                crossing = -height_now / speed
                start = np.where(speed < 0.0, np.maximum(start, crossing), start)
                end = np.where(speed > 0.0, np.minimum(end, crossing), end)
            nearest = float(np.min(start[start <= end]))
            assert RADIUS - c["penetration"] == pytest.approx(nearest, abs=1e-4)  # rays are 3e-4 rad apart
            kinds.add(int(np.argmax(np.abs(c["normal"]))) if np.max(np.abs(c["normal"])) > 0.999 else 3)
    assert {2, 3} <= kinds  # plane and edge were met
    if (yaw, camber) == (0.0, 0.0):
        assert 0 in kinds  # and the face


@pytest.mark.parametrize(("yaw", "camber"), [(0.0, 0.0), (0.5, 0.1)])
def test_kerb_penetration_has_a_continuous_gradient(yaw, camber):
    road = KerbRoad(0.0, 0.08)
    axis = axis_of(yaw, camber)
    step = 1e-6
    last = None
    for x in np.linspace(-0.3, 0.3, 601):
        centre = np.array([x, 0.1, 0.30])
        c = contacts(road, centre, axis, RADIUS)[0]
        gradient = np.array(
            [
                (
                    contacts(road, centre + d, axis, RADIUS)[0]["penetration"]
                    - contacts(road, centre - d, axis, RADIUS)[0]["penetration"]
                )
                / (2.0 * step)
                for d in step * np.eye(3)
            ]
        )
        assert np.allclose(gradient, -c["normal"] / c["cosine"], atol=1e-5)
        assert np.linalg.norm(c["normal"]) == pytest.approx(1.0, abs=ROUND_OFF)
        assert c["cosine"] == pytest.approx(-c["normal"] @ c["down"], abs=1e-10)
        assert last is None or np.max(np.abs(gradient - last)) < 0.02  # 1 mm further on: no jump
        last = gradient


@pytest.mark.parametrize(("depth", "behind", "axis"), [(0.02, 0.01, 0), (0.01, 0.02, 2)])
def test_a_wheel_within_the_step_leaves_it_by_the_nearest_side(depth, behind, axis):
    """Its centre is so far below the top and so far behind the face."""
    c = contacts(KerbRoad(0.0, 0.08), [-behind, 0.0, 0.08 - depth], [0.0, 1.0, 0.0], RADIUS)[0]
    assert c["penetration"] == pytest.approx(RADIUS + min(depth, behind), abs=ROUND_OFF)
    assert np.allclose(c["normal"], np.eye(3)[axis], atol=ROUND_OFF)


def test_disc_rolls_over_the_edge_along_a_circle_about_it():
    road = KerbRoad(0.0, 0.08)
    for fall in (0.01, 0.05):
        x = np.sqrt(RADIUS**2 - (RADIUS - fall) ** 2)
        c = contacts(road, [x, 0.0, 0.08 + RADIUS - fall], [0.0, 1.0, 0.0], RADIUS)[0]
        assert c["penetration"] == pytest.approx(0.0, abs=ROUND_OFF)
        assert np.allclose(c["point"], [0.0, 0.0, 0.08], atol=ROUND_OFF)


def test_grid_of_a_plane_is_the_plane():
    x, y = np.meshgrid(np.arange(8) * 0.5 - 1.0, np.arange(6) * 0.4 - 1.0, indexing="ij")
    grid = GridRoad((-1.0, -1.0), (0.5, 0.4), 0.1 + 0.08 * x - 0.05 * y, 0.7)
    plane = PlaneRoad(0.1, 0.08, -0.05, 0.7)
    for centre in ([0.3, 0.2, 0.35], [0.5, -0.2, 0.4], [-0.9, 0.9, 0.3]):
        (a,), (b,) = (contacts(road, centre, axis_of(0.2, 0.1), RADIUS) for road in (grid, plane))
        for key, value in a.items():
            assert np.allclose(value, b[key], atol=1e-12), key


def test_grid_meets_its_points_and_is_c1_between_cells():
    rng = np.random.default_rng(7)
    heights, frictions = 0.02 * rng.normal(size=(6, 5)), rng.uniform(0.3, 1.0, size=(6, 5))
    road = GridRoad((0.0, 0.0), (1.0, 1.0), heights, frictions, 0.5)
    for i in range(6):
        for j in range(5):
            # a small disc just above the point sees the road under its centre
            (c,) = contacts(road, [i, j, heights[i, j]], [0.0, 1.0, 0.0], 1e-9)
            assert c["point"][2] == pytest.approx(heights[i, j], abs=1e-8)
            assert c["friction"] == pytest.approx(0.5 * frictions[i, j], rel=1e-6)
    jumps = []
    for x in (1.0, 2.0, 3.0):
        before, after = (
            contacts(road, [x + d, 2.3, 0.25], [0.0, 1.0, 0.0], RADIUS)[0]["normal"] for d in (-1e-7, 1e-7)
        )
        jumps.append(np.max(np.abs(before - after)))
    assert max(jumps) < 1e-5
    assert (
        np.ptp([contacts(road, [x, 2.3, 0.25], [0.0, 1.0, 0.0], RADIUS)[0]["normal"][0] for x in (0.5, 1.5, 2.5)])
        > 1e-3
    )


def test_grid_goes_on_level_outside():
    road = GridRoad((0.0, 0.0), (1.0, 1.0), [[0.0, 0.1], [0.2, 0.3]], 0.9)
    for x, y, z in ((-5.0, -5.0, 0.0), (9.0, 9.0, 0.3), (-5.0, 9.0, 0.1), (1e9, -1e9, 0.2)):
        (c,) = contacts(road, [x, y, 0.5], [0.0, 1.0, 0.0], RADIUS)
        assert c["point"][2] == pytest.approx(z, abs=1e-7)
        assert np.allclose(c["normal"], [0.0, 0.0, 1.0])


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: PlaneRoad(friction=-0.1).real, "friction of a plane road is -0.1"),
        (lambda: KerbRoad(0.0, 0.0).real, "step of a kerb is 0"),
        (lambda: KerbRoad(0.0, 0.1, upper="left").real, "'before' or 'after'"),  # type: ignore[arg-type]
        (lambda: GridRoad((0, 0), (1, 1), [[0.0]]).real, "at least 2 x 2"),
        (lambda: GridRoad((0, 0), (1, 0), np.zeros((2, 2))).real, "spacing"),
        (lambda: GridRoad((0, 0), (1, 1), np.zeros((2, 2)), np.zeros((3, 2))).real, "both must agree"),
        (lambda: GridRoad((0, 0), (1, 1), np.zeros((2, 2)), -1.0).real, "not negative"),
        (lambda: GridRoad((0, 0), (1, 1), np.full((2, 2), np.nan)).real, "not finite"),
    ],
)
def test_bad_roads_are_refused_with_a_sentence(make, sentence):
    with pytest.raises(ValueError, match=re.escape(sentence)):
        make()  # type: ignore[operator]


@pytest.mark.parametrize(
    ("kind", "real", "word"),
    [
        (0, [0.0, 0.0, 0.0, 0.9], None),
        (0, [0.0, 0.0, 0.9], "4 numbers"),
        (0, [0.0, 0.0, 0.0, -1.0], "friction"),
        (1, [0.0, 0.0, 0.08, 1.0, 0.9], None),
        (1, [0.0, 0.0, 0.08, 0.5, 0.9], "side"),
        (1, [0.0, 0.0, -0.08, 1.0, 0.9], "step"),
        (2, [2.0, 2.0, 0.0, 0.0, 1.0, 1.0, 1.0, *[0.0] * 4, *[0.9] * 4], None),
        (2, [2.0, 3.0, 0.0, 0.0, 1.0, 1.0, 1.0, *[0.0] * 4, *[0.9] * 4], "2 x 2"),
        (2, [2.0, 2.0, 0.0, 0.0, 1.0, 1.0, 1.0, *[0.0] * 4, *[0.9] * 5], "one height"),
        (2, [2.5, 2.0, 0.0, 0.0, 1.0, 1.0, 1.0, *[0.0] * 5, *[0.9] * 5], "one height"),
        (2, [1e9, 1e9, 0.0, 0.0, 1.0, 1.0, 1.0], "2 x 2"),
        (2, [], "2 x 2"),
        (7, [], "unknown"),
    ],
)
def test_kernel_checks_roads(kind, real, word):
    text = library().harness_road_check(kind, (ctypes.c_double * max(1, len(real)))(*real), len(real))
    assert text is None if word is None else word in text.decode()


def test_parameter_that_spoils_a_grid_leaves_a_road_without_contact():
    real = (ctypes.c_double * 15)(2.0, 1e6, 0.0, 0.0, 1.0, 1.0, 1.0, *[0.0] * 4, *[0.9] * 4)
    out = (ctypes.c_double * 24)()
    centre, axis = (ctypes.c_double * 3)(0.0, 0.0, 0.1), (ctypes.c_double * 3)(0.0, 1.0, 0.0)
    assert library().harness_contacts(2, 15, real, centre, axis, ctypes.c_double(RADIUS), out) == 0
