"""Steps in which a force of a contact or a stop changes abruptly are made in halves, others are not."""

from dataclasses import replace

import numpy as np
import pytest

import mbs
from benchmarks.car import accuracy, manoeuvres, trajectories
from mbs.results.run_report import Report
from mbs.vehicle import load as load_car
from mbs.vehicle.levels import errors

CAR = "commonroad_escort"
NAME = "kerb_lock_brake"
STEP = 0.005  # s
NEVER = mbs.Settings(max_halvings=0)


def load_error(h: float, settings: mbs.Settings | None = None) -> tuple[float, Report]:
    """Of the hardest manoeuvre against its reference, over the largest load."""
    every = round(manoeuvres.sampling(NAME, CAR) / h)
    run = manoeuvres.run(NAME, h, car=CAR, every=every, settings=settings)
    assert run.report is not None
    return errors.load_error(run, trajectories.read(NAME, CAR)[1]), run.report


def test_loads_behind_an_edge_are_right_where_whole_steps_are_not() -> None:
    whole, undivided = load_error(STEP, NEVER)
    result, divided = load_error(STEP)
    assert whole > 2.0 * accuracy.LOAD_BOUND
    assert result < accuracy.LOAD_BOUND
    assert (undivided.divisions, divided.halvings) == (0, 0)
    assert 0 < divided.divisions < 0.15 * divided.steps
    assert divided.iterations < 1.1 * undivided.iterations


def test_a_drive_without_edges_keeps_its_bits() -> None:
    manoeuvre = replace(manoeuvres.load("slalom", CAR), stop_time=2.0)
    system = manoeuvres.system_of("slalom", CAR)
    actual, whole = (manoeuvres.run_on(system, manoeuvre, STEP, settings=s) for s in (None, NEVER))
    assert actual.report is not None
    assert actual.report.divisions == 0
    assert all((actual[name] == whole[name]).all() for name in trajectories.SENSORS)


def test_the_largest_force_is_that_of_tyres_and_springs() -> None:
    """Of whole steps: parts of steps may have larger ones."""
    system = mbs.compile(load_car("prototype").model())
    simulation = mbs.Simulation(system, pose=mbs.Pose(z=0.27, speed=3.0), settings=NEVER)
    run = simulation.run(0.5, STEP, progress=False, estimate_error=False)
    wheels = ("FL", "FR", "RL", "RR")
    forces = [f"wheel_{w}.{f}" for w in wheels for f in ("Fx", "Fy", "Fz")] + [f"spring_{w}.force" for w in wheels]
    largest = simulation.instance.report()["largest_force"]
    assert largest == pytest.approx(max(np.abs(run[n][1:]).max() for n in forces), rel=1e-6)
