"""Contact point and normal that a tyre reports: closed forms on planes, kerbs and grids, on the road and in the air."""

import numpy as np
import pytest

from mbs.elements import GridRoad, KerbRoad, PlaneRoad
from tests.elements.harness import Array, axis_of
from tests.elements.tyre_data import TYRE, tyre_element

R = TYRE.radius
ROUND_OFF = 1e-12


def contact(road: object, centre: Array, axis: Array) -> tuple[Array, Array, float]:
    """Point, normal and vertical force of a wheel at rest."""
    u = np.concatenate([centre, axis, [0.0]])
    out = tyre_element(TYRE, road)(u, np.zeros(7)).out  # type: ignore[arg-type]
    point, normal = (np.array([out[f"{name}_{c}"] for c in "xyz"]) for name in ("contact", "normal"))
    return point, normal, out["vertical_force"]


def foot(centre: Array, axis: Array, q: Array, n: Array) -> Array:
    """Nearest point of the plane through q with normal n that lies in the wheel's plane."""
    down = (n @ axis) * axis - n
    down /= np.linalg.norm(down)
    return centre + (n @ (q - centre)) / (n @ down) * down


@pytest.mark.parametrize("height", [0.9 * R, 0.95 * R, 1.3 * R, 40.0])
def test_on_level_ground_it_lies_below_the_centre_within_the_wheel_plane(height: float) -> None:
    centre = np.array([3.0, -2.0, 0.1 + height])
    for toe, camber in ((0.0, 0.0), (0.3, 0.0), (0.2, 0.15), (-0.4, -0.2)):
        point, normal, force = contact(PlaneRoad(0.1), centre, axis_of(toe, camber))
        leftward = np.array([-np.sin(toe), np.cos(toe), 0.0])
        expected = centre + height * (np.tan(camber) * leftward - np.array([0.0, 0.0, 1.0]))
        assert np.allclose(point, expected, atol=ROUND_OFF * (1.0 + height))
        assert np.array_equal(normal, [0.0, 0.0, 1.0])
        assert (force > 0.0) == (height / np.cos(camber) < R)


@pytest.mark.parametrize("gap", [-0.02, 0.0, 0.1])
def test_on_a_slope_normal_and_point_are_those_of_its_plane(gap: float) -> None:
    road = PlaneRoad(0.3, 0.08, -0.05)
    n = np.array([-0.08, 0.05, 1.0])
    n /= np.linalg.norm(n)
    q = np.array([5.0, 4.0, 0.3 + 0.08 * 5.0 - 0.05 * 4.0])
    centre, axis = q + (R + gap) * n, axis_of(0.25, 0.1)
    point, normal, _ = contact(road, centre, axis)
    assert np.allclose(normal, n, atol=ROUND_OFF)
    assert np.allclose(point, foot(centre, axis, q, n), atol=ROUND_OFF)
    assert point[2] == pytest.approx(0.3 + 0.08 * point[0] - 0.05 * point[1], abs=ROUND_OFF)
    assert (point - centre) @ axis == pytest.approx(0.0, abs=ROUND_OFF)


def bumps() -> GridRoad:
    x, y = np.meshgrid(np.arange(41) * 0.25 - 5.0, np.arange(41) * 0.25 - 5.0, indexing="ij")
    return GridRoad((-5.0, -5.0), (0.25, 0.25), 0.1 * np.sin(x) + 0.05 * np.cos(1.3 * y))


def test_on_a_grid_it_is_the_point_of_the_surface_nearest_in_the_wheel_plane() -> None:
    """The surface by a scan of wheels that just touch it, independent of the search of the tyre."""
    rng = np.random.default_rng(5)
    for _ in range(10):
        x, y, toe = rng.uniform(-3.0, 3.0), rng.uniform(-3.0, 3.0), rng.uniform(-0.5, 0.5)
        z = 0.1 * np.sin(x) + 0.05 * np.cos(1.3 * y)
        centre, axis = np.array([x, y, z + 0.97 * R]), axis_of(toe, 0.05)
        point, normal, force = contact(bumps(), centre, axis)
        assert force > 0.0
        assert point[2] == pytest.approx(0.1 * np.sin(point[0]) + 0.05 * np.cos(1.3 * point[1]), abs=3e-4)
        slope = np.array([-0.1 * np.cos(point[0]), 0.065 * np.sin(1.3 * point[1]), 1.0])
        assert np.allclose(normal, slope / np.linalg.norm(slope), atol=3e-3)
        along = np.cross(axis, [0.0, 0.0, 1.0]) / np.linalg.norm(np.cross(axis, [0.0, 0.0, 1.0]))
        ways = np.linspace(-0.2, 0.2, 2001)  # the line of the surface in the wheel plane
        line = centre + ways[:, None] * along
        up = np.cross(along, axis)
        for _ in range(5):
            gap = line[:, 2] - 0.1 * np.sin(line[:, 0]) - 0.05 * np.cos(1.3 * line[:, 1])
            line = line - gap[:, None] / up[2] * up
        nearest = line[np.argmin(np.linalg.norm(line - centre, axis=1))]
        assert np.linalg.norm(point - nearest) < 3e-3


def test_on_the_edge_of_a_kerb_it_is_the_edge() -> None:
    road = KerbRoad(0.0, 0.08)
    centre = np.array([0.6 * R, 1.0, 0.08 + 0.78 * R])
    point, normal, force = contact(road, centre, np.array([0.0, 1.0, 0.0]))
    assert force > 0.0
    assert np.allclose(point, [0.0, 1.0, 0.08], atol=ROUND_OFF)
    assert np.allclose(normal, np.array([0.6, 0.0, 0.78]) / np.hypot(0.6, 0.78), atol=ROUND_OFF)


@pytest.mark.parametrize(("x", "expected"), [(-1.0, 0.08), (0.5, 0.0), (30.0, 0.0)])
def test_in_the_air_over_a_kerb_it_is_the_level_below(x: float, expected: float) -> None:
    """Not the edge that it flew over, though the slips refer to the step."""
    point, normal, force = contact(KerbRoad(0.0, 0.08), np.array([x, 0.0, 0.4]), np.array([0.0, 1.0, 0.0]))
    assert force == 0.0
    assert np.allclose(point, [x, 0.0, expected], atol=ROUND_OFF)
    assert np.array_equal(normal, [0.0, 0.0, 1.0])


def test_of_edge_and_lower_level_it_is_the_mean_by_load() -> None:
    road = KerbRoad(0.0, 0.05)
    centre = np.array([0.55 * R, 0.0, 0.97 * R])
    point, normal, force = contact(road, centre, np.array([0.0, 1.0, 0.0]))
    to_edge = np.array([0.0, 0.0, 0.05]) - centre
    distances = np.linalg.norm(to_edge), 0.97 * R
    depth = R - np.array(distances)
    assert np.all(depth > 0.0)
    loads = TYRE.stiffness * depth
    assert force == pytest.approx(loads.sum(), rel=1e-12)
    shares = loads / loads.sum()
    assert np.allclose(point, shares[0] * np.array([0.0, 0.0, 0.05]) + shares[1] * (centre * [1.0, 1.0, 0.0]))
    mean = shares[0] * -to_edge / distances[0] + shares[1] * np.array([0.0, 0.0, 1.0])
    assert np.allclose(normal, mean / np.linalg.norm(mean), atol=ROUND_OFF)
