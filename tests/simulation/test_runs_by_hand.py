"""Runs of a Simulation: checked by repeats from their start, to a tolerance, with switches in between."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import mbs
from mbs import Simulation
from mbs.simulation import fixed_steps

QUIET = {"progress": False}


def swing(at: float = 1.0) -> mbs.System:
    """A pendulum that a switch can hold."""
    m = mbs.Model("swing", dimension=2)
    bar = m.body("bar", mass=1.0, com=(at, 0.0), inertia=0.1)
    m.revolute("hinge", m.ground, bar, point=(0.0, 0.0))
    m.pin("hold", bar)
    push = m.input("push", unit="N.m")
    spring = m.spring_damper("spring", (m.ground, (0.0, 1.0)), (bar, (at, 0.0)), stiffness=1.0)
    m.parameter("stiffness", 1.0, 0.1, 10.0, targets=[(spring, "stiffness", 1.0)])
    m.torque_on("torque", m.relative_angle("angle", m.ground, bar), input=push)
    m.sense_position("x", bar, None, "x")
    m.sense_position("y", bar, None, "y")
    return mbs.compile(m)


def test_a_checked_run_continues_bit_for_bit() -> None:
    checked, plain = (Simulation(swing(), inputs={"push": 0.3}, parameters={"stiffness": 5.0}) for _ in range(2))
    for simulation, estimate in ((checked, True), (plain, False)):
        simulation.run(0.5, 0.005, estimate_error=estimate, **QUIET)
        simulation.set_switch("hold", True)
        simulation.run(0.6, 0.005, estimate_error=estimate, **QUIET)
        simulation.set_switch("hold", False)
        simulation.run(1.0, 0.005, inputs={"push": lambda t: np.sin(t)}, estimate_error=estimate, **QUIET)
    assert checked.instance.save() == plain.instance.save()


def test_steps_that_threads_make_of_one_simulation_are_made_one_after_the_other() -> None:
    shared, alone = Simulation(swing()), Simulation(swing())
    with ThreadPoolExecutor(8) as pool:
        list(pool.map(lambda _: shared.step(0.001, 5), range(400)))
    alone.step(0.001, 2000)
    assert shared.instance.save() == alone.instance.save()


def test_the_refined_instance_continues_from_run_to_run() -> None:
    simulation = Simulation(swing())
    first = simulation.run(1.0, 0.01, estimate_error=True, **QUIET)
    second = simulation.run(2.0, 0.01, estimate_error=True, **QUIET)
    assert first.accuracy.compared_step == second.accuracy.compared_step == 0.005
    whole = mbs.simulate(swing(), 2.0, 0.01, estimate_error=True, **QUIET)
    assert second.accuracy.sensors == pytest.approx(whole.accuracy.sensors, rel=1e-3)
    assert 0.0 < first.accuracy.error < whole.accuracy.error


@pytest.mark.parametrize("another", [False, True])
def test_the_refined_instance_continues_from_a_saved_state(another: bool) -> None:
    """Here and in another Simulation, after runs that are made again; damaged bytes change nothing."""
    simulation = Simulation(swing())
    simulation.run(1.0, 0.01, estimate_error=True, **QUIET)
    state = simulation.save()
    second = simulation.run(2.0, 0.01, estimate_error=True, **QUIET)
    second_state = simulation.save()
    other = Simulation(swing()) if another else simulation
    size = simulation.instance.system.state_size
    mixed = second_state[:size] + state[size:]
    for bad in (state[:-300], state[: len(state) // 2], state[:-1], mixed):
        with pytest.raises(mbs.SimulationError, match="saved state was refused"):
            other.restore(bad)
    other.restore(state)
    assert other.save() == state
    again = other.run(2.0, 0.01, estimate_error=True, **QUIET)
    assert again.accuracy.sensors == second.accuracy.sensors


def test_a_restored_start_forgets_the_ranges_of_what_is_taken_back() -> None:
    """A run after it has the error of a run from the start, though the discarded motion was ten times as wide."""
    fresh, used = Simulation(swing()), Simulation(swing())
    start = used.save()
    used.run(1.0, 0.002, inputs={"push": lambda t: 30.0 + t}, **QUIET)
    used.restore(start)
    errors = [s.run(0.2, 0.02, estimate_error=True, **QUIET).accuracy.error for s in (fresh, used)]
    assert errors[0] == errors[1] > 0.0


@pytest.mark.parametrize("ends", [[1.0, 1.05, 2.0], list(0.05 * np.arange(1, 41))])
def test_short_runs_are_checked_and_do_not_end_the_refined_one(ends: list[float]) -> None:
    """They were not, and ended it, so that the error of all runs before them was forgotten."""
    simulation = Simulation(swing())
    for end in ends:
        run = simulation.run(end, 0.01, estimate_error=True, **QUIET)
    whole = mbs.simulate(swing(), 2.0, 0.01, estimate_error=True, **QUIET)
    assert run.accuracy.sensors == pytest.approx(whole.accuracy.sensors, rel=0.05)


def test_steps_by_hand_are_made_by_the_refined_run_too() -> None:
    simulation = Simulation(swing())
    simulation.run(1.0, 0.01, estimate_error=True, **QUIET)
    simulation.step(0.01, 40)
    simulation.step(0.02, 5)
    run = simulation.run(2.0, 0.01, estimate_error=True, **QUIET)
    whole = mbs.simulate(swing(), 2.0, 0.01, estimate_error=True, **QUIET)
    assert run.accuracy.compared_step == 0.005
    assert run.accuracy.sensors == pytest.approx(whole.accuracy.sensors, rel=0.3)
    simulation.run(2.1, 0.01, estimate_error=False, **QUIET)
    assert simulation._refined is None


def test_a_refined_run_that_was_refused_does_not_continue(monkeypatch: pytest.MonkeyPatch) -> None:
    """The next run was compared with it from another time, 0.4 s behind."""
    march = fixed_steps.march

    def refuse(simulation, t_end, h, *more):
        if h < 0.01 and t_end == 1.0:
            march(simulation, 0.6, h, *more)
            raise mbs.SimulationError("it fell apart", 0.6, 7)
        return march(simulation, t_end, h, *more)

    monkeypatch.setattr(fixed_steps, "march", refuse)
    simulation = Simulation(swing())
    with pytest.warns(mbs.AccuracyWarning, match="was refused"):
        simulation.run(1.0, 0.01, estimate_error=True, **QUIET)
    assert 0.0 < simulation.run(2.0, 0.01, estimate_error=True, **QUIET).accuracy.error < 0.01


def test_a_loop_of_short_runs_that_is_wrong_is_reported() -> None:
    """A controller that acts every fifth step: nothing else shows that the steps are too long."""
    simulation = Simulation(swing(0.05))

    def controlled() -> None:
        for end in 0.1 * np.arange(1, 41):
            push = float(np.clip(1.0 - simulation.sensors["y"], -20.0, 20.0))
            simulation.run(end, 0.02, inputs={"push": push}, **QUIET)

    with pytest.warns(mbs.AccuracyWarning, match="off by"):
        controlled()


def test_a_tolerance_holds_across_switches() -> None:
    simulation, fine = Simulation(swing()), Simulation(swing())
    errors = []
    for end, on in ((0.8, True), (1.0, False), (2.0, False)):
        run = simulation.run(end, tolerance=1e-4, **QUIET)
        fine.run(end, 1e-4, estimate_error=False, every=100, **QUIET)
        assert run.t[-1] == simulation.time == end
        assert [run[c][-1] for c in "xy"] == [simulation.sensors[c] for c in "xy"]
        errors.append(max(abs(simulation.sensors[c] - fine.sensors[c]) for c in "xy") / run.control.length)
        for one in (simulation, fine):
            one.set_switch("hold", on)
    assert 0.0 < max(errors) < 5e-4
    assert simulation.settings == fine.settings
    simulation.step(0.001, 10)


def test_a_run_needs_a_step_or_a_tolerance() -> None:
    with pytest.raises(ValueError, match="needs a step h or a tolerance"):
        Simulation(swing()).run(1.0)
