"""Inputs within a step: a mass under a force that is a function of time, a table or the last value set."""

import math
from collections.abc import Callable

import numpy as np
import pytest

import mbs
from mbs.kernel.binding import KernelError, LoadedSystem, Status
from mbs.kernel.binding.instance import Instance
from mbs.kernel.header.enumerations import ElementType
from mbs.settings.methods import METHOD_TABLE

from .system_builder import Element, SystemBuilder

MASS = 2.0
FORCE = 4.0  # N, the largest
ROUND_OFF = 1e-14
CLOSE = 1e-9
METHODS = ("ali3p", "ali3p_generalised_alpha", "energy_momentum", "runge_kutta_8", "radau_5")


def pushed(method: str = "runge_kutta_8") -> Instance:
    """A mass on a line, at rest, under an input force between -4 and 4 N."""
    b = SystemBuilder(np.array([[MASS]]), [0.0])
    b.inputs = [(0.0, -FORCE, FORCE)]
    b.elements = [Element(ElementType.INPUT_FORCE, [b.signal({0: 1.0})], [1.0], [0])]
    instance = Instance(LoadedSystem(b.to_bytes()))
    instance.set_settings(method=METHOD_TABLE[method].number)
    instance.initialise(0.0)
    return instance


def given(value: Callable[[float], float]) -> Callable[[float, bool, object], None]:
    def function(t: float, after: bool, values: object) -> None:
        values[0] = value(t)  # type: ignore[index]

    return function


def position(instance: Instance) -> float:
    return float(instance.get_state()[0][0])


def velocity(instance: Instance) -> float:
    return float(instance.get_state()[1][0])


def test_a_function_is_seen_at_the_stages_of_a_step() -> None:
    """F = sin(t): x = (t - sin(t)) / m, to the order of the method in one step."""
    instance, h = pushed(), 0.5
    instance.set_input_function(given(math.sin))
    instance.step(h)
    assert position(instance) == pytest.approx((h - math.sin(h)) / MASS, rel=1e-9)
    assert velocity(instance) == pytest.approx((1.0 - math.cos(h)) / MASS, rel=1e-9)


def test_a_function_is_held_in_the_range_of_its_input() -> None:
    for sign in (1.0, -1.0):
        instance = pushed()
        instance.set_input_function(given(lambda _, sign=sign: 10.0 * sign * FORCE))
        instance.step(0.5)
        assert velocity(instance) == pytest.approx(sign * FORCE / MASS * 0.5, rel=ROUND_OFF)


def test_a_function_without_a_number_ends_the_step_and_changes_nothing() -> None:
    instance = pushed()
    instance.step(0.1)
    before = [bytes(part) for part in instance.get_state()]
    instance.set_input_function(given(lambda _: math.nan))
    with pytest.raises(KernelError) as refusal:
        instance.step(0.1)
    assert refusal.value.status == Status.BAD_ARGUMENT
    assert [bytes(part) for part in instance.get_state()] == before


@pytest.mark.parametrize("method", METHODS)
def test_a_value_that_was_set_holds_from_its_time_on(method: str) -> None:
    """F = F1 from the start of the step: x = F1 h^2 / 2 m; also from the second step on, and what it goes back to."""
    instance, h = pushed(method), 0.1
    instance.step(h)
    instance.set_input(0, 3.0)
    instance.step(h)
    assert velocity(instance) == pytest.approx(3.0 / MASS * h, rel=CLOSE)
    assert position(instance) == pytest.approx(0.5 * 3.0 / MASS * h**2, rel=CLOSE)
    instance.step(h)
    instance.set_input(0, 0.0)
    instance.step(h)
    assert velocity(instance) == pytest.approx(2.0 * 3.0 / MASS * h, rel=CLOSE)
    assert position(instance) == pytest.approx(4.0 * 3.0 / MASS * h**2, rel=CLOSE)


@pytest.mark.parametrize("method", [m for m in METHODS if "alpha" not in m])  # it shifts forces in time
def test_rows_of_a_run_are_reached_in_straight_lines(method: str) -> None:
    """F = F1 t / 2 h over two steps: v = F1 h / m."""
    instance, h = pushed(method), 0.1
    instance.run(h, 2, np.array([1.5, 3.0]))
    assert velocity(instance) == pytest.approx(3.0 * h / MASS, rel=CLOSE)
    assert instance.get_input(0) == 3.0


def test_a_halved_step_follows_the_straight_line() -> None:
    """The first half ends at half of the torque, as when two steps are asked for."""
    m, h = mbs.Model("rod", dimension=2), 0.1
    rod = m.body("rod", mass=2.0, com=(0.5, 0.0), inertia=0.16)
    m.revolute("hinge", m.ground, rod, point=(0.0, 0.0))
    torque = m.input("torque", min=-30.0, max=30.0, unit="N.m")
    m.torque_on("motor", m.relative_angle("angle", m.ground, rod), input=torque)
    simulation = mbs.Simulation(mbs.compile(m))
    simulation.step(0.01, 20)
    instance = simulation.instance
    instance.set_settings(max_iterations=3, max_halvings=1)
    before = instance.save()
    instance.run(h, 1, np.array([20.0]))
    assert instance.report()["halvings"] == 1
    halved = [bytes(part) for part in instance.get_state()]
    instance.restore(before)
    instance.run(0.5 * h, 2, np.array([10.0, 20.0]))
    assert instance.report()["halvings"] == 0
    assert halved == [bytes(part) for part in instance.get_state()]


def test_a_value_that_is_set_again_solves_nothing() -> None:
    first, second = pushed("ali3p"), pushed("ali3p")
    for instance in (first, second):
        instance.run(0.1, 2, np.array([1.5, 3.0]))
    second.set_input(0, 3.0)
    for instance in (first, second):
        instance.step(0.1)
    assert first.save() == second.save()


def test_a_state_before_a_jump_continues_bit_for_bit() -> None:
    instance = pushed("ali3p")
    instance.run(0.1, 3, np.array([1.5, 3.0, 2.0]))
    instance.set_input(0, -1.0)
    before = instance.save()
    instance.run(0.1, 2)
    after = instance.save()
    other = pushed("ali3p")
    other.restore(before)
    other.run(0.1, 2)
    assert other.save() == after


def test_a_table_is_linear_between_its_times() -> None:
    """F = 2 t until 1 s, then 2 N: integrals of polynomials, which the method meets exactly."""
    instance = pushed()
    instance.set_input_tables({0: (np.array([0.0, 1.0]), np.array([0.0, 2.0]))}, 1e-9)
    instance.run(0.25, 4)
    assert velocity(instance) == pytest.approx(1.0 / MASS, rel=ROUND_OFF)
    assert position(instance) == pytest.approx(1.0 / (3.0 * MASS), rel=ROUND_OFF)
    instance.run(0.25, 4)
    assert velocity(instance) == pytest.approx(3.0 / MASS, rel=ROUND_OFF)


@pytest.mark.parametrize("method", METHODS)
def test_a_jump_is_of_the_step_behind_it(method: str) -> None:
    """Three steps of 0.1 s miss 0.3 s by round-off; the force that begins there moves nothing before."""
    instance = pushed(method)
    instance.set_input_tables({0: (np.array([0.0, 0.3, 0.3, 1.0]), np.array([0.0, 0.0, 3.0, 3.0]))}, 1e-7)
    instance.run(0.1, 3)
    assert instance.time != 0.3
    assert velocity(instance) == 0.0
    instance.run(0.1, 1)
    assert velocity(instance) == pytest.approx(3.0 / MASS * 0.1, rel=CLOSE)
