"""Factors on springs, dampers and bars: no bit changes at one, and they scale the stated coefficients."""

from dataclasses import replace

import numpy as np
import pytest

from mbs import Model, compile
from mbs.elements import EndStops, ScalarSpringDamper, SpringDamper
from mbs.simulation.stepping import Simulation
from tests.elements.harness import Element, signals, vectors

STOPS = EndStops(0.9, 8e3, 1.1, 5e3, bump_progression=0.05)


def both(element: Element, scaled: Element, discrete: bool) -> None:
    """The same forces, tangent and energy, bit by bit."""
    rng = np.random.default_rng(5)
    n = len(element.element.signals)
    for _ in range(30):
        u, ud = rng.normal(size=(2, n))
        a, b = (e(u, ud, None, 0.01, 0.005, 2.5e-5, discrete=discrete) for e in (element, scaled))
        for x, y in ((a.f, b.f), (a.S, b.S), (a.potential, b.potential)):
            assert np.array_equal(x, y)


@pytest.mark.parametrize("stops", [None, EndStops(0.9, 8e3, 1.1, 5e3), STOPS])
@pytest.mark.parametrize("discrete", [False, True])
def test_with_twice_the_numbers_and_half_the_factors_bits_are_the_same(stops: EndStops | None, discrete: bool) -> None:
    spring = SpringDamper(1234.5, 67.8, 0.9, stops)
    doubled = SpringDamper(2469.0, 0.5 * 67.8, 0.9, stops)
    scaled = replace(spring, stiffness_factor=2.0, damping_factor=0.5)
    both(*(Element(e.record("s", vectors(3)[0])) for e in (doubled, scaled)), discrete)


def test_a_bar_scales_its_torque() -> None:
    bar = ScalarSpringDamper(300.0, 7.0, 0.2, 5.0)
    scaled = replace(bar, stiffness_factor=2.0, damping_factor=0.5)
    both(*(Element(e.record("s", signals(1)[0])) for e in (ScalarSpringDamper(600.0, 3.5, 0.2, 5.0), scaled)), False)


def test_a_damper_that_is_switched_off_takes_no_energy() -> None:
    for spring in (SpringDamper(10.0, 5.0, 0.1), ScalarSpringDamper(10.0, 5.0)):
        signal = vectors(3)[0] if isinstance(spring, SpringDamper) else signals(1)[0]
        assert not Element(spring.record("s", signal)).conservative  # type: ignore[arg-type]
        assert Element(replace(spring, damping_factor=0.0).record("s", signal)).conservative  # type: ignore[arg-type]


def test_a_parameter_writes_a_factor_beside_one_of_the_number() -> None:
    def hung(stiffness: float, factor: float) -> Model:
        m = Model("hung", dimension=2, gravity=(0.0, -9.81))
        bob = m.point_mass("bob", mass=2.0, position=(0.0, -1.1))
        element = m.add(
            SpringDamper(stiffness, 3.0, 1.0, stiffness_factor=factor).record(
                "spring", m.ground.point((0.0, 0.0)) - bob.point((0.0, -1.1))
            )
        )
        m.parameter("stiffness", stiffness, 0.0, 1e3, "N/m", targets=[(element, "stiffness", 1.0)])
        m.parameter("factor", factor, 0.0, 3.0, "1", targets=[(element, "stiffness_factor", 1.0)])
        m.sense_position("y", bob, component="y")
        return m

    changed = Simulation(compile(hung(150.0, 1.0)), parameters={"stiffness": 200.0, "factor": 1.5})
    rebuilt = Simulation(compile(hung(200.0, 1.5)))
    for simulation in (changed, rebuilt):
        simulation.step(0.01, n=100)
    assert changed.sensors["y"] == rebuilt.sensors["y"]
