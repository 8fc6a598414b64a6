"""Cost of the check of a run: no refined run whose outcome is known, and none omitted that would detect an error."""

from typing import Any

import numpy as np
import pytest

import mbs
from benchmarks.methods import random_machines
from mbs.results.comparison import COORDINATES
from mbs.simulation.coarser_run import CoarserRuns, TooFarError
from mbs.simulation.refined_run import RefinedRuns
from tests.simulation.drawn import drawn
from tests.simulation.test_coarser_runs import ball


def swing() -> mbs.System:
    """A pendulum of 1 rad/s, small enough to be linear: 0.02 rad."""
    m = mbs.Model("swing", dimension=2, gravity=(0.0, -2.0))
    b = m.body("rod", mass=1.0, com=(0.0, -1.0), inertia=1.0)
    m.revolute("hinge", b, m.ground, point=(0.0, 0.0))
    m.initial_velocity(b, linear=(0.02, 0.0), angular=0.02)
    m.sense_position("x", b, (0.0, -1.0), component="x")
    return mbs.compile(m)


@pytest.mark.parametrize(
    ("seed", "number", "steps", "method"),
    [
        pytest.param(2, 76, 50, "semi_recursive_4", id="8 % off, plainly smooth by v + h a"),
        pytest.param(3, 96, 100, "runge_kutta_8", id="15 % off, twice the step agrees within 5 %"),
    ],
)
def test_chains_that_were_silent_are_reported(seed, number, steps, method):
    system, span = drawn("chain", seed, number)
    with pytest.warns(mbs.AccuracyWarning, match="off by"):
        mbs.simulate(system, span, span / steps, every=steps // 50, method=method, progress=False)


@pytest.mark.parametrize(
    ("method", "cost"),
    [
        pytest.param("semi_recursive_4", 0.51, id="eight times the step is too far off, and given up"),
        ("semi_recursive", 0.125),
    ],
)
def test_a_right_tree_of_high_order_is_compared_with_eight_times_its_step(method, cost):
    run = mbs.simulate(swing(), 20.0, 0.2, method=method, progress=False)
    assert run.accuracy is not None
    assert run.accuracy.check_cost == pytest.approx(cost, abs=0.01)
    assert np.abs(run["x"] - 0.02 * np.sin(run.t)).max() < 0.005 * 0.02


def test_a_coarser_run_ends_where_both_agree_and_the_rest_is_smooth():
    """At 0.78 s, after an impact from 0.5 to 0.6 s, of 1.25 s."""
    run = mbs.simulate(ball(1e3, 0.5, loads=True), 1.25, 0.0025, every=4, progress=False)
    assert run.accuracy is not None
    assert run.accuracy.check_cost == pytest.approx(0.3145)
    assert run.accuracy.compared_step == 0.005
    assert 0.0 < run.accuracy.units["N"] < 0.005


def never(*_: Any) -> Any:
    raise AssertionError("no run is made")


@pytest.mark.parametrize(
    ("grown", "ends"),
    [
        pytest.param(lambda t: 1e-3 + 0.0 * t, True, id="stays"),
        pytest.param(lambda t: 2e-3 * t, True, id="in proportion to time"),
        pytest.param(lambda t: 4e-3 + 0.0 * t, False, id="more than a tenth of what it may be"),
    ],
)
def test_a_coarser_run_continues_where_both_differ(grown, ends):
    system, t = ball(1e3, 0.9), np.linspace(0.0, 1.0, 101)
    run = mbs.simulate(system, 1.0, 0.01, estimate_error=False, progress=False)
    look = CoarserRuns(RefinedRuns(system, (run, []), never, 0.01, 1, never)).watch(run, 0.03, 40)
    values = np.column_stack([run[name] for name in run.units])
    values[:, list(run.units).index("x")] += grown(t) * np.ptp(run["x"])
    assert look(values[:51]) == ends
    assert not look(values[:31])
    values[20] += 0.04
    with pytest.raises(TooFarError):
        look(values[:31])


def machine(number: int) -> tuple[mbs.System, float]:
    """A random one of seed 1, and its span, s."""
    _, machine = random_machines.random_machine(np.random.default_rng([1, number]))
    return mbs.compile(random_machines.model_of(machine)), machine.span


def test_no_16th_of_the_step_follows_where_an_eighth_decides():
    """The larger error counted: 15 runs in place of 31, and the same verdict on 5.1 %."""
    system, span = machine(56)
    with pytest.warns(mbs.AccuracyWarning, match=r"off by about 5\.1 %"):
        run = mbs.simulate(system, span, span / 100, every=2, progress=False)
    assert run.accuracy is not None
    assert run.accuracy.check_cost == 14.0


def test_the_budget_of_refined_runs_is_kept_and_unchecked_runs_are_reported():
    system, span = machine(97)

    def judged(most: float | None) -> mbs.Trajectory:
        return mbs.simulate(system, span, span / 250, every=5, progress=False, estimate_error=most)

    for most, spent, words in ((1.0, 0.152, "there is no estimate"), (10.0, 6.152, "is 3.9 % of the largest range")):
        with pytest.warns(mbs.AccuracyWarning, match=f"not checked: .* budget of {most:g} runs .*{words}") as caught:
            run = judged(most)
        assert run.accuracy is not None
        assert run.accuracy.check_cost == pytest.approx(spent)
        needed = float(str(caught[0].message).split("estimate_error=")[1].split(")")[0])
        enough, free = judged(needed).accuracy, judged(None).accuracy
        assert enough == free
        assert enough is not None
        assert enough.check_cost <= needed == 31.0  # 0.152, and half down to a 16th of the step
        assert not enough.message
    assert "at most 64 unless estimate_error=N" in str(run.accuracy)


def test_coordinates_are_compared_at_the_same_instants_in_all_runs():
    """Of a System that senses a force alone they are kept, at some instants."""
    system = ball(1e3, 0.5, loads=True, motion=False)
    run = mbs.simulate(system, 1.25, 1.25 / 302, progress=False)
    assert run.accuracy is not None
    assert run.accuracy.check_cost > 0.0
    assert 0.0 < run.accuracy.units[COORDINATES] < 0.05
