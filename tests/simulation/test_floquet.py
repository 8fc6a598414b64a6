"""Floquet multipliers against the reduced equation of a shaken pendulum and against a steady motion."""

import warnings

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import BPoly, PPoly

from mbs import (
    AccuracyWarning,
    BendingWarning,
    LinearisationWarning,
    Model,
    Settings,
    Simulation,
    compile,
    floquet,
)
from mbs.elements.spring_damper import EndStops
from tests.flexible_engine.bodies import soft_pendulum

GRAVITY = 9.81


@pytest.mark.parametrize("amplitude", [0.02, 0.25], ids=["stable", "unstable"])
def test_a_shaken_pendulum_has_the_multipliers_of_its_reduced_equation(amplitude):
    """Pivot at a piecewise quintic height s(t): theta'' = -(g + s'') sin(theta); about theta = 0."""
    omega, length = 6.0, 1.0
    period = 2.0 * np.pi / omega
    t = np.linspace(0.0, 2.0 * period, 41)
    shape = PPoly.from_bernstein_basis(_quintic(t, amplitude, omega))
    m = Model("shaken pendulum", dimension=2)
    pivot = m.point_mass("pivot", mass=1.0, position=(0.0, 0.0))
    bob = m.point_mass("bob", mass=1.0, position=(0.0, -length))
    m.point_on_line("rail", (pivot, None), (m.ground, (0.0, 0.0)), axis=(0.0, 1.0))
    m.drive("shaker", pivot.point()[1], m.guide_time("height", shape, unit="m"))
    m.distance("rod", pivot, bob)
    simulation = Simulation(compile(m), settings=Settings(method="radau_5"))
    actual = floquet(simulation, period, period / 100)

    second = shape.derivative(2)

    def rate(time, x):
        return [x[1], -(GRAVITY + second(time)) * x[0] / length]

    ends = [solve_ivp(rate, (0.0, period), x, rtol=1e-11, atol=1e-13, max_step=0.01).y[:, -1] for x in np.eye(2)]
    expected = np.linalg.eigvals(np.array(ends).T)
    np.testing.assert_allclose(sorted(np.abs(actual.multipliers)), sorted(np.abs(expected)), rtol=1e-4)
    assert (np.abs(actual.multipliers).max() > 1.01) == (amplitude > 0.1)


def _quintic(t, amplitude, omega):
    c, s = np.cos(omega * t), np.sin(omega * t)
    values = amplitude * np.column_stack([c - 1.0, -omega * s, -(omega**2) * c])
    return BPoly.from_derivatives(t, values)


def test_a_motion_that_does_not_come_back_is_refused():
    m = Model("pendulum", dimension=2)
    bob = m.point_mass("bob", mass=1.0, position=(1.0, 0.0))
    m.distance("rod", (m.ground, (0.0, 0.0)), bob)
    with pytest.raises(ValueError, match="from where it began"):
        floquet(Simulation(compile(m)), 1.0, 0.01)


def _oscillator(damping=0.5, stops=None):
    """1 kg on 900 N/m: 30 rad/s."""
    m = Model("oscillator", dimension=2, gravity=(0.0, 0.0))
    mass = m.point_mass("mass", mass=1.0, position=(1.0, 0.0))
    m.point_on_line("line", (mass, None), (m.ground, (0.0, 0.0)), axis=(1.0, 0.0))
    ends = (m.ground, (2.0, 0.0)), (mass, None)
    m.spring_damper("spring", *ends, stiffness=900.0, damping=damping, free_length=1.0, stops=stops)
    return compile(m)


@pytest.mark.parametrize(
    ("method", "h", "advice"), [("ali3p", 0.008, 0.001), ("ali3p", 0.05, None), ("radau_5", 0.06, 0.029)]
)
def test_steps_that_are_too_long_are_reported_and_the_advised_ones_are_right(method, h, advice):
    """At rest every period comes back, so that the motion itself shows nothing of the step."""
    system = _oscillator()
    expected = np.exp(np.roots([1.0, 0.5, 900.0]))
    words = "much shorter than 0.025 s" if advice is None else f"Take steps of {advice:g} s"
    with pytest.warns(AccuracyWarning, match=words):
        wrong = floquet(Simulation(system, settings=Settings(method=method)), 1.0, h)
    off = np.abs(np.sort_complex(wrong.multipliers) - np.sort_complex(expected)).max() / np.abs(expected[0])
    assert off > 0.05
    if advice is None:
        return
    assert wrong.error == pytest.approx(off, rel=0.1)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        right = floquet(Simulation(system, settings=Settings(method=method)), 1.0, advice)
    np.testing.assert_allclose(np.sort_complex(right.multipliers), np.sort_complex(expected), atol=0.01)
    assert right.error < 0.01


def test_each_multiplier_counts():
    """Two masses in one model, one 30 times as fast: its error is not that of a sum of disturbances."""
    m = Model("two oscillators", dimension=2, gravity=(0.0, 0.0))
    for name, y, stiffness, damping in (("slow", 0.0, 1.0, 0.0), ("fast", 1.0, 900.0, 6.0)):
        mass = m.point_mass(name, mass=1.0, position=(1.0, y))
        m.point_on_line(f"{name} line", (mass, None), (m.ground, (0.0, y)), axis=(1.0, 0.0))
        ends = (m.ground, (2.0, y)), (mass, None)
        m.spring_damper(f"{name} spring", *ends, stiffness=stiffness, damping=damping, free_length=1.0)
    with pytest.warns(AccuracyWarning, match=r"the multiplier near -?0\.0\d+[+-]0\.0\d+j is off by about \d+\.\d%"):
        model = floquet(Simulation(compile(m), settings=Settings(method="ali3p")), 1.0, 0.008)
    expected = np.exp(np.roots([1.0, 6.0, 900.0]))
    off = np.abs(np.sort_complex(model.multipliers[2:]) - np.sort_complex(expected)).max() / np.abs(expected[0])
    assert model.error == pytest.approx(off, rel=0.1)
    assert np.abs(model.multipliers[:2] - np.exp([1j, -1j])).min() < 1e-4


def test_small_multipliers_are_right_beside_large_ones():
    """Upside down with a damper: disturbances grow 330 times, so that their size counts."""
    m = Model("inverted pendulum", dimension=2)
    rod = m.body("rod", mass=1.0, com=(0.0, 0.5), inertia=0.75)
    m.revolute("pivot", m.ground, rod, point=(0.0, 0.0))
    angle = m.relative_angle("angle", m.ground, rod)
    m.torsional_spring_damper("damper", angle, stiffness=0.0, damping=0.1)
    actual = floquet(Simulation(compile(m), settings=Settings(method="radau_5")), 2.7, 0.02).multipliers
    expected = np.exp(2.7 * np.roots([1.0, 0.1, -0.5 * GRAVITY]))
    np.testing.assert_allclose(np.sort(np.abs(actual)), np.sort(np.abs(expected)), rtol=0.02)


@pytest.mark.parametrize("distance", [0.0, 1e-3], ids=["touches", "apart"])
def test_a_stop_that_just_touches_is_reported(distance):
    system = _oscillator(stops=EndStops(bump_length=1.0 - distance, bump_stiffness=5000.0))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        floquet(Simulation(system, settings=Settings(method="radau_5")), 1.0, 0.002)
    assert [w.category for w in caught] == ([] if distance else [LinearisationWarning])


def test_disturbances_that_die_away_are_not_reported():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        model = floquet(Simulation(_oscillator(damping=60.0)), 1.0, 0.002)
    assert np.abs(model.multipliers).max() < 1e-6


def test_bending_during_the_period_is_reported():
    """A soft bar that falls from rest is straight at the start."""
    with pytest.warns(BendingWarning, match="bends by"), pytest.raises(ValueError, match="from where it began"):
        floquet(Simulation(soft_pendulum(1)), 1.0, 0.0025)
