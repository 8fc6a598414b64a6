"""Tolerances beside the length of the drawing: of a small motion, of sensors; and methods that cannot hold one."""

from collections.abc import Callable

import numpy as np
import pytest

import mbs
from benchmarks.methods import random_machines
from mbs.results.accuracy import AccuracyWarning
from mbs.simulation.controlled_run import ControlledRun, StalledError


def spring_of_a_large_drawing() -> mbs.System:
    """1 kg that falls by 1 mm on a spring 1 m away: 141 rad/s."""
    m = mbs.Model("spring", dimension=2, gravity=(0.0, -9.81))
    mass = m.point_mass("mass", mass=1.0, position=(1.0, 0.0))
    m.point_on_line("line", (mass, (1.0, 0.0)), (m.ground, (1.0, 0.0)), axis=(0.0, 1.0))
    m.spring_damper("spring", (m.ground, (1.0, -1.0)), mass, stiffness=2e4, free_length=1.0)
    m.sense_position("y", mass, None, "y")
    return mbs.compile(m)


def fall_off(run: mbs.Trajectory) -> float:
    """By how much the motion on the spring is off, m."""
    return float(np.abs(run["y"] - 9.81 / 2e4 * (np.cos(np.sqrt(2e4) * run.t) - 1.0)).max())


def test_a_tolerance_of_a_drawing_that_hides_the_motion_is_reported() -> None:
    system = spring_of_a_large_drawing()
    with pytest.warns(AccuracyWarning, match=r"moves farthest moves 0\.00098.* is 11 % of that") as caught:
        coarse = mbs.simulate(system, 1.0, tolerance=1e-2, progress=False)
    assert caught[0].filename == __file__
    assert fall_off(coarse) > 0.1 * np.ptp(coarse["y"])
    named = float(str(caught[0].message).rsplit("tolerance=", 1)[1].rstrip("."))
    assert fall_off(mbs.simulate(system, 1.0, tolerance=named, progress=False)) < 0.01 * np.ptp(coarse["y"])


@pytest.mark.parametrize("most", [1e-4, 1e-8])
def test_a_tolerance_may_be_that_of_a_sensor(most: float) -> None:
    run = mbs.simulate(spring_of_a_large_drawing(), 1.0, tolerance={"y": most}, progress=False)
    assert run.control is not None
    assert fall_off(run) < most
    assert set(run.control.sensors) == {"y"}
    assert "of 'y'" in str(run.control)
    by_hand = mbs.Simulation(spring_of_a_large_drawing()).run(0.1, tolerance={"y": most}, progress=False)
    assert fall_off(by_hand) < most


@pytest.mark.parametrize(
    ("tolerance", "message"),
    [({}, "names no sensor"), ({"x": 1.0}, "computes no such sensor"), ({"y": 0.0}, "must be a number above 0")],
)
def test_a_tolerance_of_sensors_that_cannot_be_is_refused(tolerance: dict[str, float], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        mbs.simulate(spring_of_a_large_drawing(), 1.0, tolerance=tolerance)


def test_a_method_that_cannot_hold_a_tolerance_hands_on(monkeypatch: pytest.MonkeyPatch) -> None:
    """To the next one that was tried, at last to ALi3-P; one that was named is refused."""
    finish = ControlledRun.finish

    def stalls(self: ControlledRun, update: Callable[[float], None]) -> None:
        if self.settings.method in refused:
            raise StalledError
        finish(self, update)

    monkeypatch.setattr(ControlledRun, "finish", stalls)
    system = spring_of_a_large_drawing()
    for refused, method in ((["runge_kutta_8"], "radau_5"), (["runge_kutta_8", "radau_5"], "ali3p")):
        run = mbs.simulate(system, 0.1, tolerance=1e-5, progress=False)
        assert run.control is not None
        assert run.control.method == method
        assert all(f"{name} cannot hold it" in run.control.reason for name in refused)
        assert fall_off(run) < 1e-5
    with pytest.raises(mbs.SimulationError, match="cannot be held by 'runge_kutta_8'"):
        mbs.simulate(system, 0.1, tolerance=1e-5, method="runge_kutta_8", progress=False)
    refused = ["runge_kutta_8", "radau_5", "ali3p"]
    with pytest.raises(mbs.SimulationError, match="cannot be held by 'runge_kutta_8'"):
        mbs.simulate(system, 0.1, tolerance=1e-5, progress=False)


def test_a_cam_is_held_though_a_third_of_its_steps_errs_too_much() -> None:
    """A follower behind a table: with at most a twentieth ALi3-P refused 1e-3, and Radau did five times its work."""
    kind, machine = random_machines.random_machine(np.random.default_rng([2, 7]))
    assert kind == "cam"
    system = mbs.compile(random_machines.model_of(machine))
    run = mbs.simulate(system, machine.span, tolerance=1e-3, progress=False)
    fine = mbs.simulate(system, machine.span, tolerance=1e-6, method="runge_kutta_8", progress=False)
    assert run.control is not None
    assert run.control.method == "ali3p"
    assert run.control.forced > 300
    assert np.abs(run["x1"] - fine["x1"]).max() < 1e-3 * run.control.length
