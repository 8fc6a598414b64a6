"""A wheel that is driven into a wall of a grid is reported by a run and by an FMU; a step that wheels climb is not."""

import warnings

import numpy as np
import pytest

import mbs
from mbs.elements import GridRoad
from mbs.roads import RoadWarning, write_road
from mbs.vehicle import load

EDGE = 8.0  # m
LOW = 0.35, 0.1  # m, height of a wall below the body, which wheels meet first, and the way over which it rises


def grid(height, run):
    """Level, then up by `height` over `run` m."""
    x = np.arange(-10.0, 30.0, 0.05)
    z = height * np.clip((x - EDGE) / run, 0.0, 1.0)
    return GridRoad((-10.0, -5.0), (0.05, 0.5), np.repeat(z[:, None], 21, axis=1), 1.0)


@pytest.fixture(scope="module")
def car():
    return mbs.compile(load("hatchback").model())


def driven(car, tmp_path, height, run, speed, h=0.002):
    file = tmp_path / "step.road"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RoadWarning)  # that the file has a wall
        write_road(grid(height, run), file)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        start, road = mbs.Pose(speed=speed), {"road.file": file}
        found = mbs.simulate(car, 10.0 / speed, h, None, None, road, pose=start, estimate_error=False, progress=False)
    return found, [str(w.message) for w in caught if w.category is RoadWarning]


def test_a_wall_is_reported_with_time_place_and_size(car, tmp_path):
    run, warnings = driven(car, tmp_path, *LOW, 15.0)
    (line,) = warnings
    assert max(run[f"wheel_{w}.Fz"].max() for w in ("FL", "FR")) > 8e4
    assert run.report.rim_x == pytest.approx(EDGE, abs=0.4)
    assert line.startswith(f"At {run.report.rim_time:.4g} s a wheel at x = {run.report.rim_x:.4g} m")
    assert run.report.rim_time == pytest.approx(EDGE / 15.0, abs=0.05)
    assert f"pressed in by {run.report.rim_pressed:.2g} m more than it holds" in line


def test_a_wall_that_the_body_meets_first_stops_it(car, tmp_path):
    run, warnings = driven(car, tmp_path, 1.0, 0.3, 15.0)
    assert warnings == []
    assert EDGE - 2.0 < run["chassis.x"].max() < EDGE
    assert run["chassis.ground_force"].max() > 8e4


def test_a_stepped_simulation_reports_it_once(car, tmp_path):
    file = tmp_path / "wall.road"
    with pytest.warns(RoadWarning, match="a face of"):
        write_road(grid(*LOW), file)
    simulation = mbs.Simulation(car, parameters={"road.file": file}, pose=mbs.Pose(speed=15.0))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        for _ in range(62):
            simulation.step(0.01)
    assert sum("the rim is pressed in" in str(w.message) for w in caught) == 1


def test_a_step_that_wheels_climb_is_not(car, tmp_path):
    run, warnings = driven(car, tmp_path, 0.08, 0.1, 10.0)
    assert warnings == []
    assert run.report.rim_pressed == 0.0
    assert run["chassis.z"].max() > run["chassis.z"][0] + 0.02


def test_a_variant_of_many_that_meets_a_wall_is_reported_with_its_number(car, tmp_path):
    """The hatchback with two ratios of its drive, which have masses of their own, in lanes; bits as alone."""
    file = tmp_path / "wall.road"
    with pytest.warns(RoadWarning, match="a face of"):
        write_road(grid(*LOW), file)
    parameter_sets = [{"road.file": file, "drive.ratio": 9.0}, {"road.file": file, "drive.ratio": 11.0}]
    variants = [
        mbs.Variant(parameters, pose=mbs.Pose(speed=v))
        for parameters, v in zip(parameter_sets, (15.0, 2.0), strict=True)
    ]
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        result = mbs.simulate_many(car, variants, 0.6, 0.002, progress=False)
    (line,) = [str(w.message) for w in caught if "pressed in" in str(w.message)]
    assert line.startswith("Variant 0: At 0.5")
    for k, variant in enumerate(variants):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RoadWarning)
            alone = mbs.simulate(
                car, 0.6, 0.002, parameters=variant.parameters, pose=variant.pose, estimate_error=False, progress=False
            )
        assert all(np.array_equal(alone[name], result.trajectories[k][name]) for name in ("chassis.x", "wheel_FL.Fz"))
