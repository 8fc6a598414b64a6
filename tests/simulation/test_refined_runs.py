"""Error estimates from refined runs, in closed form."""

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import mbs
from benchmarks.car import manoeuvres
from benchmarks.references.cases import system_of
from mbs.kernel.header.enumerations import Status
from mbs.kernel.header.limits import WRONG_ERROR
from mbs.results.accuracy import RIGHT, Accuracy
from mbs.results.convergence import may_change_verdict, observed_order
from mbs.simulation.refined_run import RefinedRuns, Run
from mbs.simulation.verdict import verdict_on


def by(**units: float) -> Accuracy:
    return Accuracy(None, None, 0.0, compared_step=0.1, order=2.0, units=units)


def test_a_run_is_wrong_only_where_a_sensor_is() -> None:
    """A car by ALi3 without projections: noise of the rack's force, of which two refined runs differ by a third, is
    judged where no place differs. It was added to the 0.9 % of the tyre forces, and a warning told these.
    """
    settings = mbs.Settings(method="ali3p_no_projection")
    with warnings.catch_warnings():
        warnings.simplefilter("error", mbs.AccuracyWarning)
        run = manoeuvres.run("double_lane_change_replay", 0.02, settings=settings, estimate_error=None)
    assert run.accuracy is not None
    assert run.accuracy.error == pytest.approx(9.2e-3, rel=0.2)


def test_a_unit_that_a_refined_run_does_not_judge_changes_no_verdict() -> None:
    assert not may_change_verdict(by(N=0.04), {"m": 0.1})
    assert may_change_verdict(by(N=0.04), {"N": 0.02})


@pytest.mark.parametrize(("near", "finest"), [(2, 4), (8, 16), (2, 7)])
@pytest.mark.parametrize("order", [1.0, 1.5])
def test_the_order_of_three_runs_is_seen(order: float, near: int, finest: int) -> None:
    """Of a run and of two with its step in parts, which tend to the truth; at least one, at most what is asked."""
    gaps = [0.1 * (n**-order - finest**-order) for n in (1, near)]
    assert observed_order(*gaps, near, finest, 8.0) == pytest.approx(order, rel=1e-9)
    assert observed_order(*gaps, near, finest, 1.2) == pytest.approx(min(order, 1.2), rel=1e-9)
    assert observed_order(gaps[1], gaps[1], near, finest, 8.0) == 1.0
    assert observed_order(gaps[0], 0.0, near, finest, 8.0) == 8.0


def test_a_tried_step_has_the_reported_error() -> None:
    """Of errors of order one an 8th of 6 % was told as 0.4 %, what half of it and both differ by."""
    system, last = oscillator(), 0

    def march(h: float, *_: Any) -> Run:
        nonlocal last
        run, last = mbs.simulate(system, 0.2, 0.01, progress=False, estimate_error=False), round(0.01 / h)
        run["y"][:] *= 1.0 + 0.2 / last
        return run, []

    refined = RefinedRuns(system, march(0.01), march, 0.01, 1, lambda _: None)
    known = refined.verdict()
    off = dict(refined.tried_steps(known))
    true = {step: 0.1 * step / 0.01 for step in off}
    assert len(off) >= 2
    assert off == pytest.approx(true, rel=0.05)


@pytest.mark.parametrize("reported", [0.017, 0.045, 0.055, 0.09])
def test_a_verdict_is_open_where_the_repeats_differ_by_more_than_it_is_clear(reported: float) -> None:
    clear = abs(reported - WRONG_ERROR)
    assert may_change_verdict(by(N=reported, m=0.001), {"N": 1.01 * clear, "m": 0.0})
    assert not may_change_verdict(by(N=reported, m=0.001), {"N": 0.99 * clear, "m": 0.0})
    assert may_change_verdict(by(N=reported, m=0.04), {"N": 0.99 * clear, "m": 0.02}) == (reported < WRONG_ERROR)


def oscillator(x: float = 0.0) -> mbs.System:
    """A mass on a spring along the line at x m."""
    m = mbs.Model("oscillator", dimension=2, gravity=(0.0, 0.0))
    mass = m.point_mass("mass", mass=1.0, position=(x, 0.02))
    m.point_on_line("guide", (mass, None), (m.ground, (x, 0.0)), axis=(0.0, 1.0))
    m.spring_damper("spring", (m.ground, (x, -1.0)), mass, stiffness=1000.0, free_length=1.0)
    for axis in "xy":
        m.sense_position(axis, mass, None, axis)
    return mbs.compile(m)


def test_what_moves_is_judged_wherever_it_lies() -> None:
    """A range below 1e-4 of the coordinates was taken for rest: 87 % off at x = 1000 m, without a word."""
    errors = []
    for x in (0.0, 1e3, 1e5):
        with pytest.warns(mbs.AccuracyWarning, match="off by at least 81 %"):
            run = mbs.simulate(oscillator(x), 2.0, 0.02, progress=False)
        assert run.accuracy is not None
        errors.append(run.accuracy.error)
    assert errors == pytest.approx([errors[0]] * 3, rel=1e-6)


@pytest.mark.parametrize(("length", "mass"), [(1.0, 1.0), (1e-6, 1e-12)])
def test_a_small_light_thing_is_judged_as_a_large_one(length: float, mass: float) -> None:
    """A pendulum from 1.5 rad is 12 % off; below 1e-4 sqrt(kg) m/s its steps were taken for smooth, without a word."""
    m = mbs.Model("pendulum", dimension=2, gravity=(0.0, -9.81))
    com = length * np.array([np.sin(1.5), -np.cos(1.5)])
    rod = m.body("rod", mass=mass, com=com, inertia=mass * length**2 / 3.0)
    m.revolute("hinge", m.ground, rod, point=(0.0, 0.0))
    m.sense_position("x", rod, None, "x")
    span = 30.0 * np.sqrt(length / 9.81)
    with pytest.warns(mbs.AccuracyWarning, match="off by about 12 %"):
        mbs.simulate(mbs.compile(m), span, span / 100, every=2, method="energy_momentum", progress=False)


def test_a_finer_run_that_is_refused_is_not_passed_over() -> None:
    """Half the step, 12 % off, may be off by as much as it says; a quarter that does not end is told."""
    system, tried, refused = oscillator(), [], set[int]()

    def march(h: float, every: int, update: Callable[[float], None], look: bool, iterations: int, *_: Any) -> Run:
        tried.append(round(0.01 / h))
        if tried[-1] in refused:
            raise mbs.SimulationError("it did not converge", 0.0, Status.NOT_CONVERGED)
        return mbs.simulate(system, 0.2, h, every=every, progress=False, estimate_error=False), []

    def repeats() -> RefinedRuns:
        tried.clear()
        return RefinedRuns(system, march(0.01, 1, lambda _: None, False, 0), march, 0.01, 1, lambda _: None)

    actual = repeats().verdict()
    assert tried == [1, 2, 4]
    assert actual.compared_step == pytest.approx(0.0025)
    refused.add(4)
    with pytest.raises(mbs.SimulationError, match="did not converge"):
        repeats().verdict()


@pytest.mark.parametrize(("finer", "reported"), [(True, False), (False, True)])
def test_an_open_balance_is_reported_where_that_of_the_refined_run_is_open_too(finer: bool, reported: bool) -> None:
    """13 % at 3 % off by steps of 0.13 s, which half of them close: where they cannot, both may be off alike."""
    system, h = system_of("double_four_bar"), 0.8 / 6

    def march(step: float, every: int, *_: Any) -> Run:
        trajectory = mbs.simulate(
            system, 0.8, step if finer else h, every=every if finer else 1, progress=False, estimate_error=False
        )
        return trajectory, []

    run = march(h, 1)
    known = verdict_on(RefinedRuns(system, run, march, h, 1, lambda _: None), always=False)
    assert known is not None
    assert known.energy_balance == pytest.approx(0.13, abs=0.01)
    assert ("J of work" in known.message) == reported
    assert ("J of work" in known.notice) != reported
    assert known.error == pytest.approx(0.031 if finer else 0.0, abs=1e-3)


@pytest.mark.parametrize("many", [False, True])
def test_an_energy_that_jumps_in_a_right_run_is_a_notice_of_it(many: bool) -> None:
    """7.8 % in steps of 0.1 s, beside positions that are right; warnings are errors here."""
    system, end, h = system_of("double_four_bar"), 0.8, 0.1
    run = mbs.simulate(system, end, h, every=2, progress=False)
    other = (
        mbs.simulate_many(system, [mbs.Variant()], end, h, every=2, progress=False).trajectories[0]
        if many
        else mbs.Simulation(system).run(end, h, every=2, progress=False)
    )
    assert other is not None
    for trajectory in (run, other):
        (notices,) = [text for text in trajectory.notices if "J of work, 7.8 %" in text]
        assert notices.endswith(RIGHT)
        assert notices in str(trajectory)
    assert other.notices == run.notices
