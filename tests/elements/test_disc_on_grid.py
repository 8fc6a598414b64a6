"""The contact of a disc with a grid, against a dense search of the profile, and the slopes of a grid at steps."""

from collections.abc import Callable

import numpy as np
import pytest

import mbs
from mbs.elements import GridRoad
from tests.elements.harness import Array, contacts
from tests.roads.test_physics import DAMPER, RADIUS, SPEED, SPRING, SPRUNG, TYRE, TYRE_DAMPER, UNSPRUNG, G, quarter_car

AXIS = np.array([0.0, 1.0, 0.0])
FOOT = 3.0  # m: x of the last point before a face


def face(height: float, spacing: float) -> GridRoad:
    """Level, then level again `height` higher from the next point on."""
    x = np.arange(-8.0, 14.0, spacing)
    x += FOOT - x[np.argmin(np.abs(x - FOOT))]
    heights = np.where(x > FOOT + 1e-9, height, 0.0)
    return GridRoad((float(x[0]), -2.0), (spacing, 1.0), np.repeat(heights[:, None], 5, axis=1))


def rising(x: Array, height: float, spacing: float) -> Array:
    """Height of such a face between its points: a cubic without slope at both ends."""
    t = np.clip((x - FOOT) / spacing, 0.0, 1.0)
    return height * t * t * (3.0 - 2.0 * t)


def above(road: GridRoad, x: float, y: float) -> tuple[float, Array]:
    """Height of a grid and its normal: a tiny disc sees the road under its centre."""
    (c,) = contacts(road, [x, y, 1.0], AXIS, 1e-9)
    return 1.0 - (1e-9 - float(c["penetration"])) * float(c["cosine"] / c["normal"][2]), c["normal"]


@pytest.mark.parametrize("height", [0.1, -0.1, 100.0])
def test_a_grid_neither_dips_before_a_step_nor_bulges(height: float) -> None:
    road = face(height, 0.25)
    for x in np.linspace(FOOT - 0.5, FOOT + 0.75, 51):
        z, normal = above(road, x, 0.3)
        assert z == pytest.approx(rising(x, height, 0.25), abs=1e-6 * abs(height))
        slope = (rising(x + 1e-6, height, 0.25) - rising(x - 1e-6, height, 0.25)) / 2e-6
        assert np.allclose(normal[:2] / normal[2], [-slope, 0.0], atol=1e-4 * abs(height))


def test_normals_are_the_gradient_and_go_on_from_cell_to_cell_where_slopes_are_limited() -> None:
    rng = np.random.default_rng(5)
    heights = np.kron([[0.0, 0.2, 0.0], [0.2, 0.2, 0.0], [0.0, 0.0, 0.2]], np.ones((3, 3)))
    road = GridRoad((0.0, 0.0), (0.7, 0.9), heights)
    inside = [above(road, *rng.uniform(1.0, 5.0, 2))[0] for _ in range(500)]
    assert -0.002 < min(inside) < max(inside) < 0.202  # central differences: -0.031 to 0.232
    d = 1e-5
    for _ in range(20):
        x, y = rng.uniform(1.0, 5.0, 2)
        slopes = [
            (above(road, x + d * (k == 0), y + d * (k == 1))[0] - above(road, x - d * (k == 0), y - d * (k == 1))[0])
            / (2.0 * d)
            for k in range(2)
        ]
        normal = above(road, x, y)[1]
        assert np.allclose(normal[:2] / normal[2], -np.array(slopes), atol=1e-6)
    for i in range(2, 7):
        for where in (lambda s, i=i: (0.7 * i + s, 2.3), lambda s, i=i: (2.3, 0.9 * i + s)):
            assert np.allclose(above(road, *where(-1e-9))[1], above(road, *where(1e-9))[1], atol=1e-6)


def test_a_smooth_road_converges_by_the_third_power_of_the_spacing() -> None:
    x, worst = np.linspace(2.0, 8.0, 97), []
    for spacing in (0.2, 0.1, 0.05):
        place = np.arange(-1.0, 11.0, spacing)
        road = GridRoad((-1.0, -1.0), (spacing, 1.0), np.repeat(0.1 * np.sin(2.0 * place)[:, None], 3, axis=1))
        worst.append(max(abs(above(road, s, 0.0)[0] - 0.1 * np.sin(2.0 * s)) for s in x))
    orders = np.log2(np.divide(worst[:-1], worst[1:]))
    assert np.all((orders > 2.8) & (orders < 3.3))


@pytest.mark.parametrize(
    ("height", "spacing", "camber"), [(0.12, 0.02, 0.1), (0.12, 0.2, 0.1), (0.05, 0.05, 0.0), (-0.1, 0.05, 0.1)]
)
def test_the_depth_is_that_of_a_dense_search(height: float, spacing: float, camber: float) -> None:
    """To 0.25 mm, by which the smooth maximum of two equal depths is larger."""
    road, rng = face(height, spacing), np.random.default_rng(1)
    axis = np.array([0.0, np.cos(camber), np.sin(camber)])
    x = np.linspace(FOOT - 1.0, FOOT + 1.0, 40001)
    z = rising(x, height, spacing)
    shared = 0
    for _ in range(200):
        centre = np.array([FOOT + rng.uniform(-0.4, 0.4), 0.0, max(height, 0.0) + rng.uniform(0.15, 0.3)])
        distance = float(np.hypot(x - centre[0], (z - centre[2]) / np.cos(camber)).min())
        actual = contacts(road, centre, axis, RADIUS)
        shared += len(actual) == 2
        assert -1e-6 < actual[0]["penetration"] - (RADIUS - distance) < 0.25e-3 + 1e-6
    assert shared > 0 or spacing > 0.05 or height < 0.0


def peak(x: Array, profile: Array, begin: float, end: float) -> float:
    """Largest load of the tyre of the quarter car over a profile, by small steps and a dense search.

    Its points x are regular; the road is level until `begin`.
    """
    h, rest, apart = 5e-5, RADIUS - (SPRUNG + UNSPRUNG) * G / TYRE, x[1] - x[0]
    at, wheel, body, speed, body_speed, most = begin, rest, 0.0, 0.0, 0.0, 0.0
    while at < end:
        near = slice(int((at - RADIUS - x[0]) / apart), int((at + RADIUS - x[0]) / apart))
        distance = np.hypot(x[near] - at, wheel - profile[near])
        k = int(np.argmin(distance))
        depth, down = RADIUS - distance[k], np.array([x[near][k] - at, profile[near][k] - wheel]) / distance[k]
        pressed = TYRE * depth + TYRE_DAMPER * (down @ [SPEED, speed]) * min(depth / 0.005, 1.0) if depth > 0.0 else 0.0
        most = max(most, pressed)
        spring = SPRUNG * G + SPRING * (wheel - rest - body) + DAMPER * (speed - body_speed)
        speed += h * (-max(pressed, 0.0) * down[1] - UNSPRUNG * G - spring) / UNSPRUNG
        body_speed += h * (spring - SPRUNG * G) / SPRUNG
        wheel, body, at = wheel + h * speed, body + h * body_speed, at + h * SPEED
    return most


@pytest.mark.parametrize(("height", "spacing"), [(0.05, 0.02), (0.03, 0.2), (0.02, 0.05)])
def test_peak_loads_are_those_of_a_dense_search(height: float, spacing: float) -> None:
    run = mbs.simulate(quarter_car(face(height, spacing)), (FOOT + 1.5) / SPEED, 0.0005, progress=False)
    x = np.arange(FOOT - 1.0, FOOT + 2.0, 1e-3)
    expected = peak(x, rising(x, height, spacing), FOOT - 0.5, FOOT + 1.5)
    assert run["load"].max() == pytest.approx(expected, rel=0.1)


def test_what_a_disc_leaves_out_of_a_wide_tyre() -> None:
    """Load at a height of the axle where 3500 N bear on level ground, against five discs over a width of 180 mm.

    Where the road is one profile across the tyre nothing is left out; the figures stand in `docs/limits.md`.
    """
    radius, stiffness, width, bears = 0.3, 2e5, 0.18, 3500.0
    stones = np.random.default_rng(3).uniform(-0.006, 0.006, (60, 40))

    def grid(height: Callable[[Array, Array], Array]) -> GridRoad:
        x, y = np.meshgrid(-2.0 + 0.02 * np.arange(201), -1.0 + 0.02 * np.arange(101), indexing="ij")
        return GridRoad((-2.0, -1.0), (0.02, 0.02), height(x, y))

    def loads(road: GridRoad, places: Array) -> Array:
        z = radius - bears / stiffness
        pressed = [
            [max(0.0, *(float(c["penetration"]) for c in contacts(road, [x, y, z], AXIS, radius))) for y in places]
            for x in np.arange(-1.0, 1.0, 0.13)
        ]
        return stiffness * np.mean(pressed, axis=1)

    def off(height: Callable[[Array, Array], Array]) -> float:
        road = grid(height)
        across = loads(road, np.linspace(-0.5, 0.5, 5) * width)
        return float(np.sqrt(np.mean((loads(road, np.zeros(1)) - across) ** 2)))

    assert off(lambda x, y: np.where(x > 0.0, 0.05, 0.0)) < 1.0
    assert off(lambda x, y: stones[(10 * (x + 2.0)).astype(int) % 60, (10 * (y + 1.0)).astype(int) % 40]) > 300.0
    assert off(lambda x, y: np.where(y > 0.364 * x, 0.05, 0.0)) > 900.0  # a kerb at 20 degrees
    assert off(lambda x, y: np.where(y > 0.0, 0.05, 0.0)) > 3900.0  # along, under half of it
