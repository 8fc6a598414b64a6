"""Inputs within a step: a mass under a force that is a function of time, a table or the last value set."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from mbs.kernel.binding import Instance, KernelError, LoadedSystem, Status
from mbs.kernel.header import ElementType
from mbs.settings.methods import METHOD_TABLE

from .system_builder import Element, SystemBuilder

MASS = 2.0
FORCE = 4.0  # N, the largest
ROUND_OFF = 1e-14


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


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_a_function_without_a_number_ends_the_step_and_changes_nothing(value: float) -> None:
    instance = pushed()
    instance.step(0.1)
    before = [bytes(part) for part in instance.get_state()]
    instance.set_input_function(given(lambda _: value))
    with pytest.raises(KernelError) as refusal:
        instance.step(0.1)
    assert refusal.value.status == Status.BAD_ARGUMENT
    assert [bytes(part) for part in instance.get_state()] == before


def test_a_value_that_was_set_is_reached_in_a_straight_line() -> None:
    """F = F1 t / h in the step: x = F1 h^2 / 6 m."""
    instance, h = pushed(), 0.5
    instance.set_input(0, 3.0)
    instance.step(h)
    assert position(instance) == pytest.approx(3.0 * h**2 / (6.0 * MASS), rel=ROUND_OFF)
    assert velocity(instance) == pytest.approx(3.0 * h / (2.0 * MASS), rel=ROUND_OFF)


def test_a_table_is_linear_between_its_times() -> None:
    """F = 2 t until 1 s, then 2 N: integrals of polynomials, which the method meets exactly."""
    instance = pushed()
    instance.set_input_tables({0: (np.array([0.0, 1.0]), np.array([0.0, 2.0]))}, 1e-9)
    instance.run(0.25, 4)
    assert velocity(instance) == pytest.approx(1.0 / MASS, rel=ROUND_OFF)
    assert position(instance) == pytest.approx(1.0 / (3.0 * MASS), rel=ROUND_OFF)
    instance.run(0.25, 4)
    assert velocity(instance) == pytest.approx(3.0 / MASS, rel=ROUND_OFF)


@pytest.mark.parametrize("method", ["ali3p", "runge_kutta_8", "radau_5"])
def test_a_jump_is_of_the_step_behind_it(method: str) -> None:
    """Three steps of 0.1 s miss 0.3 s by round-off; the force that begins there moves nothing before."""
    instance = pushed(method)
    instance.set_input_tables({0: (np.array([0.0, 0.3, 0.3, 1.0]), np.array([0.0, 0.0, 3.0, 3.0]))}, 1e-7)
    instance.run(0.1, 3)
    assert instance.time != 0.3
    assert velocity(instance) == 0.0
    instance.run(0.1, 1)
    if method != "ali3p":  # whose accelerations at the start of a step are those of its past
        assert velocity(instance) == pytest.approx(3.0 / MASS * 0.1, rel=1e-10)
