"""Runs to a tolerance of motions with growing errors: comparisons of two inaccurate runs are not conclusive."""

import numpy as np
import pytest

import mbs
from mbs.elements import EndStops, SpringDamperTable
from mbs.model.point_mass import PointMass
from tests.simulation.drawn import drawn

TOLERANCE = 1e-2


def test_the_error_of_a_chain_is_within_ten_tolerances() -> None:
    """Two coarse runs are off alike: 11 tolerances off, guessed as 0.6."""
    system, span = drawn("chain", 2, 204)
    times = np.linspace(0.0, span, 51)
    run, true, other = (
        mbs.simulate(system, span, times=times, tolerance=tolerance, method=method, progress=False)
        for method, tolerance in ((None, TOLERANCE), ("runge_kutta_8", 1e-9), ("radau_5", 1e-7))
    )
    assert run.control is not None
    places = [name for name in run.units if name.startswith("tip")]
    sure = max(np.abs(true[n] - other[n]).max() for n in places) / run.control.length
    assert sure < 0.01 * TOLERANCE
    error = max(np.abs(run[n] - true[n]).max() for n in places) / run.control.length
    assert error < 10.0 * TOLERANCE
    assert run.control.kept


def mass_on_a_line(speed: float) -> tuple[mbs.Model, PointMass]:
    """A mass of 1 kg, 1 m from the origin, that moves away from it."""
    m = mbs.Model("mass on a line", dimension=2, gravity=(0.0, 0.0), length=1.0)
    mass = m.point_mass("mass", mass=1.0, position=(1.0, 0.0))
    m.point_on_line("line", (mass, None), (m.ground, (0.0, 0.0)), axis=(1.0, 0.0))
    m.initial_velocity(mass, linear=(speed, 0.0))
    m.sense_position("x", mass, None, "x")
    return m, mass


@pytest.mark.parametrize(
    ("method", "gap", "speed", "stiffness"),
    [
        ("runge_kutta_8", 0.041, 0.87, 230.0),
        ("runge_kutta_8", 0.048, 0.35, 233.0),
        ("radau_5", 0.036, 0.91, 130.0),
    ],
)
def test_a_step_that_meets_a_stop_keeps_no_order(method: str, gap: float, speed: float, stiffness: float) -> None:
    """By the order of the method the error of the kink counted as a 31st or 63rd of what it is."""
    m, mass = mass_on_a_line(speed)
    stop = EndStops(rebound_length=1.0 + gap, rebound_stiffness=stiffness)
    m.spring_damper("stop", (m.ground, (0.0, 0.0)), (mass, None), stiffness=0.0, free_length=1.0, stops=stop)
    t = np.linspace(0.0, 2.0, 51)
    frequency = np.sqrt(stiffness)
    met, left = gap / speed, gap / speed + np.pi / frequency
    inside = speed / frequency * np.sin(frequency * (t - met))
    true = 1.0 + np.where(t < met, speed * t, np.where(t < left, gap + inside, gap - speed * (t - left)))
    run = mbs.simulate(mbs.compile(m), 2.0, tolerance=1e-3, times=t, method=method)
    assert run.control is not None
    assert np.abs(run["x"] - true).max() < 10.0 * run.control.error


def test_runs_to_two_tolerances_do_not_begin_with_the_same_steps() -> None:
    """A row of the table in these steps left the same error in both runs, ten times their difference."""
    gap, stiffness = 0.0176, 58.9
    m, mass = mass_on_a_line(0.64)
    rows = ((-0.5, 0.0), (0.0, 0.0), (gap, 0.0), (gap + 0.05, -0.025 * stiffness), (gap + 1.0, -stiffness))
    spring = SpringDamperTable(spring=rows, free_length=1.0)
    m.add(spring.record("spring", mass.point() - m.ground.point((0.0, 0.0))))
    system, t = mbs.compile(m), np.linspace(0.0, 1.0, 51)
    true = mbs.simulate(system, 1.0, tolerance=1e-10, times=t, method="runge_kutta_8")
    run = mbs.simulate(system, 1.0, tolerance=1e-3, times=t, method="radau_5")
    assert run.control is not None
    assert np.abs(run["x"] - true["x"]).max() < 10.0 * run.control.error
