"""Energy-momentum methods where the step changes: the carried velocity has a part off the rows that belongs to the step
it comes from, and must not become a force in a shorter one.
"""

import numpy as np
import pytest

import mbs
from benchmarks.references import motions as references
from mbs.scenes import pendulum

G = 9.81
METHODS = ("energy_momentum", "energy_momentum_4")


def tension(y: float) -> float:
    """Of the rod of the pendulum that started level, bob of 1 kg at height y, rod of 1 m."""
    return -3.0 * G * y


@pytest.fixture(scope="module")
def system() -> mbs.System:
    return mbs.compile(pendulum.build())


@pytest.mark.parametrize("method", METHODS)
def test_a_cut_of_the_step_is_no_force(system: mbs.System, method: str) -> None:
    cut = 1000
    s = mbs.Simulation(system, settings=mbs.Settings(method=method))
    s.step(0.01, 50)
    for h in (0.01 / cut, 0.01 / cut, 0.01):
        s.step(h)
        now = s.sensors
        assert now["rod.tension"] == pytest.approx(tension(now["bob.position.y"]), abs=0.05)


def test_short_steps_behind_a_long_one_start_from_forces_that_are_right(system: mbs.System) -> None:
    """Each step is solved in as few iterations as there can be; from -442 N in place of 29 it takes two."""
    s = mbs.Simulation(system, settings=mbs.Settings(method="energy_momentum"))
    s.step(0.02, 30)
    before = s.report.iterations
    s.step(2e-5, 50)
    s.step(2e-7, 50)
    assert s.report.iterations - before <= 120


@pytest.mark.parametrize(("method", "order"), [("energy_momentum", 2), ("energy_momentum_4", 3)])
def test_order_and_energy_where_every_step_is_another(system: mbs.System, method: str, order: int) -> None:
    """Each restart moves the velocity by its error, which costs the composition of order four one order."""
    errors = []
    for h in (0.01, 0.005):
        tight = mbs.Settings(method=method, tolerance_r=1e-13, tolerance_phi=1e-13)
        s = mbs.Simulation(system, settings=tight)
        start = s.sensors["energy.total"]
        for _ in range(round(2.0 / (2.0 * h))):
            s.step(1.5 * h)
            s.step(0.5 * h)
        exact = references.pendulum(np.array([0.0, s.time]))[-1]
        now = s.sensors
        errors.append(float(np.hypot(now["bob.position.x"] - exact[0], now["bob.position.y"] - exact[1])))
        assert abs(now["energy.total"] - start) < 1e-7
    assert np.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.5)


def test_equal_steps_keep_their_carried_velocity(system: mbs.System) -> None:
    """Nothing is restarted for round-off in the step, so that equal steps stay symmetric."""
    one, other = (mbs.Simulation(system, settings=mbs.Settings(method="energy_momentum")) for _ in range(2))
    for k in range(100):
        one.step(0.01)
        other.step(0.01 * (1.0 + 1e-12 * (-1) ** k))
    assert one.sensors["rod.tension"] == pytest.approx(other.sensors["rod.tension"], abs=1e-7)
