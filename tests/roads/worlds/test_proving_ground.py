"""The proving ground: heights and slopes in closed form, frictions and surfaces at places, no steps."""

import math
from pathlib import Path

import numpy as np
import pytest

from hosts.driving.course import TRACKS, course_of
from mbs.worlds.make_world import read_world
from mbs.worlds.scenery import cone_positions, scenery_of
from mbs.worlds.terrain import Terrain
from mbs.worlds.world_types import FRICTIONS, Cones

FILE = Path(__file__).parents[3] / "mbs" / "worlds" / "proving_ground.toml"


@pytest.fixture(scope="module")
def terrain():
    return Terrain(read_world(FILE), FILE.parent)


def line(a, b, step=0.01):
    """Places along a line, and the way along it."""
    n = round(math.hypot(b[0] - a[0], b[1] - a[1]) / step) + 1
    return np.linspace(a[0], b[0], n), np.linspace(a[1], b[1], n), np.linspace(0.0, step * (n - 1), n)


def test_the_straight_is_600_m_and_level(terrain):
    for y in (-5.5, 0.0, 5.5):
        x, y, _ = line((-20.0, y), (580.0, y), 0.5)
        assert np.abs(terrain.at(x, y)).max() < 1e-9


def test_the_hill_rises_and_falls_by_20_percent_with_rounded_crests(terrain):
    """Stations: the back straight begins at 640 + 60 pi, at x = 620, and goes along -x; vertices at 945 to 1075."""
    begin = 640.0 + 60.0 * math.pi
    x, y, s = line((620.0 - (925.0 - begin), 120.0), (620.0 - (1100.0 - begin), 120.0))
    z = terrain.at(x, y)
    s = 925.0 + s
    slope, bend = np.gradient(z, s), np.diff(z[::25], 2) / 0.25**2
    up, down = (s > 960.0) & (s < 980.0), (s > 1040.0) & (s < 1060.0)
    assert np.abs(slope[up] - 0.2).max() < 1e-6
    assert np.abs(slope[down] + 0.2).max() < 1e-6
    assert np.abs(z[up] - 0.2 * (s[up] - 945.0)).max() < 1e-6
    assert z.max() == pytest.approx(10.0, abs=1e-9)
    assert np.abs(z[(s > 1008.0) & (s < 1012.0)] - 10.0).max() < 1e-9
    assert np.abs(bend).max() == pytest.approx(0.2 / 24.0, rel=1e-3)  # a radius of 120 m
    for offset in (-5.9, 5.9):  # level across
        assert np.abs(terrain.at(x, y + offset) - z).max() < 1e-6


def test_the_curve_is_banked_by_25_percent_about_its_inner_edge(terrain):
    for angle in np.radians([-60.0, -10.0, 0.0, 30.0, 80.0]):
        r = np.linspace(54.0, 66.0, 25)
        z = terrain.at(620.0 + r * np.cos(angle), 60.0 + r * np.sin(angle))
        assert np.abs(z - 0.25 * (r - 54.0)).max() < 1e-4
    arc = np.linspace(-0.5 * math.pi, 0.5 * math.pi, 4000)
    along = terrain.at(620.0 + 64.0 * np.cos(arc), 60.0 + 64.0 * np.sin(arc))
    assert np.abs(np.diff(along)).max() < 1e-4
    x, y, s = line((560.0, -5.0), (640.0, -5.0))
    z = terrain.at(x, y)
    assert np.abs(z[x <= 580.0]).max() < 1e-9
    assert np.abs(np.gradient(z, s)).max() < 1.875 * 0.25 * 11.0 / 35.0 + 0.02  # the soft rise over 35 m


def profile(terrain, x0, x1, y, step=0.005):
    x, y, s = line((x0, y), (x1, y), step)
    return x, terrain.at(x, y), s


def test_kerbs_are_80_mm_up_and_down_and_under_one_side_only(terrain):
    x, z, s = profile(terrain, 78.0, 88.0, 30.0)
    assert z.max() == pytest.approx(0.08, abs=1e-12)
    assert np.abs(z[(x < 80.0) | (x > 86.0)]).max() == 0.0
    assert np.abs(z[(x > 80.32) & (x < 85.68)] - 0.08).max() < 1e-12
    assert np.abs(np.gradient(z, s)).max() == pytest.approx(2.0 * 0.08 / 0.32, rel=2e-2)
    right, left = (float(terrain.at(np.array([123.0]), np.array([y]))[0]) for y in (29.2, 30.8))
    assert (right, left) == (pytest.approx(0.08), 0.0)
    right, left = (float(terrain.at(np.array([153.0]), np.array([y]))[0]) for y in (29.2, 30.8))
    assert (right, left) == (0.0, pytest.approx(0.08))


@pytest.mark.parametrize(("x0", "height"), [(90.0, 0.3), (360.0, 1.0)])
def test_ramps_have_their_heights_a_slope_of_18_percent_and_a_rounded_back(terrain, x0, height):
    _, z, s = profile(terrain, x0 - 1.0, x0 + 12.0, 62.0, 0.001)
    slope = np.gradient(z, s)
    assert z.max() == pytest.approx(height, abs=1e-6)
    assert slope.max() == pytest.approx(0.18, rel=1e-6)
    assert -0.7 - 1e-6 < slope.min() < (-0.7 + 1e-6 if height > 0.4 else -0.5)  # the low one is all roundings
    bend = np.gradient(slope, s)[5:-5]
    assert np.abs(bend).max() == pytest.approx(0.88 / 0.5, rel=1e-3)  # a radius of 0.57 m: no edge for a wheel
    up = (z > 0.5 * height) & (slope > 0.0) & (z < 0.6 * height)
    assert np.abs(slope[up] - 0.18).max() < 1e-6


@pytest.mark.parametrize(
    ("x0", "length", "wavelength", "height"), [(220.0, 108.0, 3.6, 0.03), (380.0, 42.0, 0.7, 0.02)]
)
def test_washboards(terrain, x0, length, wavelength, height):
    x, z, _ = profile(terrain, x0, x0 + length, 30.0)
    full = (x > x0 + 1.1 * wavelength) & (x < x0 + length - 1.1 * wavelength)
    assert np.abs(z[full] - 0.5 * height * np.sin(2.0 * math.pi * (x[full] - x0) / wavelength)).max() < 1e-9
    assert np.ptp(z) == pytest.approx(height, rel=1e-3)


@pytest.mark.parametrize(
    ("x", "y", "surface", "friction"),
    [
        (100.3, 0.2, "asphalt", FRICTIONS["asphalt"]),
        (200.0, -83.0, "wet", 0.3),
        (200.0, -77.0, "asphalt", FRICTIONS["asphalt"]),
        (360.0, -80.0, "ice", FRICTIONS["ice"]),
        (70.0, -205.0, "gravel", FRICTIONS["gravel"]),
        (100.0, 200.0, "grass", FRICTIONS["grass"]),
        (83.0, 30.0, "concrete", FRICTIONS["concrete"]),
        (495.0, -165.0, "asphalt", FRICTIONS["asphalt"]),
        (495.0, -224.0, "grass", FRICTIONS["grass"]),
    ],
)
def test_surfaces_and_frictions_at_places(terrain, x, y, surface, friction):
    _, classes, _ = terrain.on_grid(np.array([x]), np.array([y]))
    assert terrain.names[classes[0, 0]] == surface
    assert terrain.frictions[classes[0, 0]] == friction


def test_the_ground_is_continuous_everywhere(terrain):
    """Differences over 2 cm along long lines in both directions, away from obstacles."""
    for y in (-200.0, -60.0, 10.0, 90.0, 140.0):
        _, z, _ = profile(terrain, -110.0, 700.0, y, 0.02)
        assert np.abs(np.diff(z)).max() < 0.02 * 0.85, y
        assert np.abs(np.diff(z, 2)).max() < 0.02**2 * 1.5, y  # and its slope
    for x0 in (-100.0, 35.0, 450.0, 570.0, 690.0):
        x, y, _ = line((x0, -255.0), (x0, 235.0), 0.02)
        z = terrain.at(x, y)
        assert np.abs(np.diff(z)).max() < 0.02 * 0.85, x0
        assert np.abs(np.diff(z, 2)).max() < 0.02**2 * 1.5, x0


def test_a_grid_of_places_and_single_places_are_the_same(terrain):
    x, y = np.linspace(70.0, 130.0, 61), np.linspace(20.0, 75.0, 56)
    z, _, _ = terrain.on_grid(x, y)
    single = terrain.at(*np.meshgrid(x, y, indexing="ij"))
    assert np.abs(z - single).max() < 1e-9
    assert np.ptp(z) > 0.2


@pytest.mark.parametrize("name", list(TRACKS))
def test_the_cones_stand_along_the_gates_that_are_driven(terrain, name):
    (cones,) = (c for c in terrain.world.cones if c.lane_change == TRACKS[name])
    gates = course_of(name, cones.vehicle_width, x_start=cones.start[0]).gates
    drawn = {tuple(part["at"][:2]) for part in scenery_of(terrain) if part["kind"] == "cone"}
    actual = set()
    for gate in gates:
        for edge in (gate.y_right, gate.y_left):
            y = round(cones.start[1] + edge, 4)
            along = [at for at in drawn if gate.x_start <= at[0] <= gate.x_end and at[1] == pytest.approx(y)]
            x = sorted(at[0] for at in along)
            assert (x[0], x[-1]) == (gate.x_start, gate.x_end), edge
            assert np.diff(x).max() < 7.0
            actual |= set(along)
    assert actual == {at for at in drawn if gates[0].x_start <= at[0] <= gates[-1].x_end and abs(at[1] + 40.0) < 20.0}


def test_the_slalom_has_cones_every_18_m(terrain):
    cones = next(c for c in terrain.world.cones if c.slalom is not None)
    places = np.array(cone_positions(cones))
    assert np.allclose(np.diff(places[:, 0]), 18.0)
    turned = np.array(cone_positions(Cones(slalom=3, start=(1.0, 2.0, 90.0))))
    assert np.allclose(turned, [(1.0, 2.0), (1.0, 20.0), (1.0, 38.0)])


def test_places_lie_on_roads_and_scenery_stands_on_the_ground(terrain):
    places = terrain.world.places
    names = {place.name for place in places}
    assert {"start", "steering_pad", "double_lane_change", "slalom", "kerbs", "ramp_1_m", "hill"} <= names
    assert {"washboard", "banked_curve", "two_frictions"} <= names
    for place in places:
        _, classes, _ = terrain.on_grid(np.array([place.at[0]]), np.array([place.at[1]]))
        assert terrain.names[classes[0, 0]] in ("asphalt", "gravel"), place.name
    scenery = scenery_of(terrain)
    feet = np.array([part["at"] for part in scenery if "at" in part])
    assert np.abs(terrain.at(feet[:, 0], feet[:, 1]) - feet[:, 2]).max() < 1e-4
    trees = np.array([part["at"] for part in scenery if part["kind"] == "tree"])
    assert len(trees) == 260
    assert terrain.nearest_layer(trees[:, 0], trees[:, 1]).min() > 14.0
    radii = [part["points"] for part in scenery if part["kind"] == "line" and len(part["points"]) > 50]
    circles = {round(float(np.hypot(p[0][0] - 495.0, p[0][1] + 165.0))) for p in radii}
    assert {15, 30, 50} <= circles
