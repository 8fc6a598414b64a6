"""Steps in which a force of a contact or a stop changes abruptly are made in halves, others are not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import mbs
from benchmarks.car import accuracy, manoeuvres, trajectories
from mbs.simulation.many_runs import Variant
from mbs.vehicle import load as load_car
from mbs.vehicle.levels import errors

CAR, NAME, STEP = "commonroad_escort", "kerb_lock_brake", 0.005
NEVER = mbs.Settings(max_halvings=0)


def load_error(h: float, settings: mbs.Settings | None = None) -> tuple[float, mbs.Report]:
    """Of the hardest manoeuvre against its reference, over the largest load."""
    every = round(manoeuvres.sampling(NAME, CAR) / h)
    run = manoeuvres.run(NAME, h, car=CAR, every=every, settings=settings)
    assert run.report is not None
    return errors.load_error(run, trajectories.read(NAME, CAR)[1]), run.report


@pytest.mark.parametrize("h", [0.005, 0.01])
def test_loads_behind_an_edge_are_right_where_whole_steps_are_not(h: float) -> None:
    whole, undivided = load_error(h, NEVER)
    found, divided = load_error(h)
    assert whole > 2.0 * accuracy.LOAD_BOUND
    assert found < accuracy.LOAD_BOUND
    assert (undivided.divisions, divided.halvings) == (0, 0)
    assert 0 < divided.divisions < 0.15 * divided.steps
    assert divided.iterations < 1.1 * undivided.iterations


def test_a_drive_without_edges_keeps_its_bits() -> None:
    manoeuvre = replace(manoeuvres.load("slalom", CAR), stop_time=2.0)
    system = manoeuvres.system_of("slalom", CAR)
    found, whole = (manoeuvres.run_on(system, manoeuvre, STEP, settings=s) for s in (None, NEVER))
    assert found.report is not None
    assert found.report.divisions == 0
    assert all((found[name] == whole[name]).all() for name in trajectories.SENSORS)


def test_lanes_divide_the_steps_that_a_single_run_does() -> None:
    system = mbs.compile(load_car(CAR).model())
    falls = [mbs.Pose(z=z, speed=8.0) for z in (0.0, 0.0, 0.1, 0.25)]
    many = mbs.simulate_many(system, [Variant(pose=pose) for pose in falls], 0.5, STEP, progress=False)
    for pose, found, alone in zip(falls, many.trajectories, many.alone, strict=True):
        single = mbs.simulate(system, 0.5, STEP, pose=pose, progress=False, estimate_error=False)
        assert found is not None
        assert found.report is not None
        assert single.report is not None
        assert found.report.divisions == single.report.divisions
        assert (found.report.divisions > 0) == (pose.z > 0.0) == (alone > 0)
        assert all((found[name] == single[name]).all() for name in trajectories.SENSORS)


def test_a_saved_state_of_such_a_run_goes_on_bit_for_bit() -> None:
    """Before, between and behind divided steps."""
    run = mbs.Simulation(mbs.compile(load_car(CAR).model()), pose=mbs.Pose(z=0.1, speed=8.0))
    for _ in range(60):
        state = run.save()
        run.step(STEP)
        ended, divisions = run.state.q.copy(), run.report.divisions
        run.restore(state)
        run.step(STEP)
        assert (run.state.q == ended).all()
        assert run.report.divisions == divisions
    assert run.report.divisions > 3
    assert np.isfinite(run.state.q).all()


def test_the_largest_force_is_that_of_tyres_and_springs() -> None:
    """Of whole steps: parts of steps may have larger ones."""
    system = mbs.compile(load_car("prototype").model())
    simulation = mbs.Simulation(system, pose=mbs.Pose(z=0.27, speed=3.0), settings=NEVER)
    run = simulation.run(0.5, STEP, progress=False, estimate_error=False)
    wheels = ("FL", "FR", "RL", "RR")
    forces = [f"wheel_{w}.{f}" for w in wheels for f in ("Fx", "Fy", "Fz")] + [f"spring_{w}.force" for w in wheels]
    largest = simulation.instance.report()["largest_force"]
    assert largest == pytest.approx(max(np.abs(run[n][1:]).max() for n in forces), rel=1e-6)
