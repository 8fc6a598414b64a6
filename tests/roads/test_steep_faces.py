"""A face of a grid that is a wall for a wheel is reported when the road is made and when a car is built on it."""

import re
import warnings
from pathlib import Path

import numpy as np
import pytest

import mbs
from mbs.elements.road import GridRoad, KerbRoad
from mbs.kernel.header.enumerations import Status
from mbs.roads import RoadWarning, write_road
from mbs.roads.road_file import RoadFile
from mbs.roads.steep_faces import steep_face
from mbs.vehicle import Car
from mbs.worlds import command as road_command

ROADS = Path(mbs.__file__).parent / "roads" / "files"
FACE = 5.0


def face(height: float, spacing: float) -> GridRoad:
    """Level, then level again `height` higher; up or down between two points from FACE on."""
    heights = np.where(np.arange(int(8.0 / spacing)) * spacing > FACE + 1e-9, height, 0.0)
    return GridRoad((0.0, -1.0), (spacing, 0.5), np.repeat(heights[:, None], 5, axis=1))


@pytest.mark.parametrize(("height", "reported"), [(0.28, False), (0.32, True), (100.0, True)])
@pytest.mark.parametrize("spacing", [0.02, 0.2])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_face_that_is_higher_than_the_radius(spacing, height, reported, sign):
    sentence = steep_face(face(sign * height, spacing), "face.road")
    assert bool(sentence) == reported
    if reported:
        place, rise, run = re.findall(
            r"x = ([\d.]+) m, y = -1 m a face of ([\d.]+) m rises within ([\d.]+) m", sentence
        )[0]
        assert float(place) <= FACE < FACE + spacing <= float(place) + 2.0 * float(run) + 1e-9
        assert float(rise) == height
        assert f"points {spacing:g} by 0.5 m apart" in sentence
        assert "0.3 m radius" in sentence


def test_a_ramp_is_no_face():
    for spacing in (0.02, 0.05, 0.1):
        z = np.clip(np.arange(0.0, 8.0, spacing) - 4.0, 0.0, 2.0)  # 45 degrees
        assert not steep_face(GridRoad((0.0, 0.0), (spacing, 1.0), np.repeat(z[:, None], 3, axis=1)), "")


def test_a_face_across_is_reported_too():
    across = face(0.5, 0.2)
    turned = GridRoad(across.origin[::-1], across.spacing[::-1], np.asarray(across.heights).T)
    assert "at x = -1 m, y = 5 m" in steep_face(turned, "")


def test_a_larger_wheel_is_reported_later():
    assert "0.3 m radius" in steep_face(face(0.35, 0.2), "", 0.3)
    assert not steep_face(face(0.35, 0.2), "", 0.4)


def test_a_long_road_is_looked_at_as_a_whole():
    heights = np.zeros((10_000, 3))
    for row in (4096, 4097, 4098, 9000):
        heights[:] = 0.0
        heights[row:] = 0.5
        assert f"x = {0.5 * (row - 1):g} m" in steep_face(GridRoad((0.0, 0.0), (0.5, 1.0), heights), "")


@pytest.mark.parametrize("spacing", [0.02, 0.05, 0.1, 0.25])
def test_smooth_roads_are_not(spacing):
    x = np.arange(0.0, 20.0, spacing)
    for amplitude, wave in ((0.05, 2.0), (0.5, 10.0), (0.0075, 0.5)):
        z = amplitude * np.sin(2.0 * np.pi * x / wave)
        assert steep_face(GridRoad((0.0, 0.0), (spacing, 1.0), np.repeat(z[:, None], 3, axis=1)), "") == ""
    noise = np.random.default_rng(1).uniform(-5e-4, 5e-4, (len(x), 20))
    assert steep_face(GridRoad((0.0, 0.0), (spacing, spacing), noise), "") == ""


@pytest.mark.parametrize("file", sorted(ROADS.glob("*.road")), ids=lambda file: file.stem)
def test_the_roads_of_the_package_are_not(file):
    road = RoadFile(file).read()
    assert not isinstance(road, GridRoad) or steep_face(road, file) == ""


def without_ground_contact(name: str) -> Car:
    car = mbs.vehicle.load(name)
    return car.model_copy(update={"chassis": car.chassis.model_copy(update={"ground_contact": None})})


def test_a_car_that_drives_into_a_wall_is_refused_with_the_position():
    """A car that stands beside it, or stops at it, is not. Its body touches nothing: it would meet the wall first."""
    x = np.arange(-10.0, 40.0, 0.2)
    wall = GridRoad((-10.0, -10.0), (0.2, 5.0), np.repeat(np.where(x > 10.1, 1.0, 0.0)[:, None], 5, axis=1), 0.9)
    with pytest.warns(RoadWarning, match="a face of 1 m"):
        car = mbs.compile(without_ground_contact("hatchback").model(wall))
    slow = mbs.simulate(car, 3.0, 0.005, pose=mbs.Pose(speed=3.0), estimate_error=False, progress=False)
    assert slow["chassis.x"][-1] < 10.0
    with pytest.raises(mbs.SimulationError) as refused:
        mbs.simulate(car, 1.0, 0.002, pose=mbs.Pose(speed=30.0), estimate_error=False, progress=False)
    match = re.search(
        r"'tyre F[LR]': at x = (\S+) m, y = (\S+) m the centre of a wheel of 0.311 m radius", str(refused.value)
    )
    assert match is not None
    assert 10.0 < float(match[1]) < 10.3
    assert abs(abs(float(match[2])) - 0.7375) < 0.02
    assert "whose points are 0.2 by 5 m apart" in str(refused.value)
    assert refused.value.status == Status.WHEEL_IN_ROAD


@pytest.mark.slow
def test_reported_where_the_road_is_made_and_where_a_car_is_built(tmp_path, capsys):
    road, file = face(0.5, 0.2), tmp_path / "face.road"
    with pytest.warns(RoadWarning, match=r"face\.road: at x = 5 m, .* of 0\.3 m radius"):
        write_road(road, file)
    with pytest.warns(RoadWarning, match=r"face\.road"):
        write_road(road, file, shared=True)
    car = mbs.vehicle.load("hatchback")
    with pytest.warns(RoadWarning, match=r"The grid road: at x = 5 m, .* of 0\.311 m radius"):
        car.model(road)
    with pytest.warns(RoadWarning, match=r"face\.road: at x = 5 m"):
        car.model(mbs.RoadFile(file))
    np.savetxt(tmp_path / "face.csv", np.asarray(road.heights), delimiter=",")
    arguments = [str(tmp_path / "face.csv"), str(tmp_path / "made.road"), "--spacing", "0.2", "0.5"]
    assert road_command.main(arguments) == 0
    assert "warning: " in (errors := capsys.readouterr().err)
    assert "a face of 0.5 m" in errors
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        car.model(KerbRoad(5.0, 0.12))
        car.model(face(0.12, 0.02))
