"""The kernel has the same bits whatever the processor of its caller does; the caller's register stays, and its function
of inputs has it."""

import platform
import sys
from collections.abc import Callable
from typing import Any

import pytest

from mbs.kernel.binding import LoadedSystem
from mbs.kernel.binding.instance import Instance
from tests.processor import DEFAULT, ODD, control, set_control

from .scenes import everything

pytestmark = pytest.mark.skipif(
    sys.platform != "linux" or platform.machine() != "x86_64", reason="the test sets the register of x86-64 Linux"
)


def under(register: int, call: Callable[..., Any], *arguments: Any) -> Any:
    """What a call gives under a control, which must still be there when it returns."""
    set_control(register)
    try:
        return call(*arguments)
    finally:
        after = control()
        set_control(DEFAULT)
        assert after == register


def bits(register: int) -> tuple[bytes, ...]:
    """Of a start, steps, and steps with a function of inputs."""
    instance = under(register, Instance, under(register, LoadedSystem, everything().to_bytes()))
    under(register, instance.initialise)
    under(register, instance.run, 0.01, 20)
    results = [under(register, instance.save)]
    visited = set()

    def inputs(t: float, after: bool, values: Any) -> None:
        visited.add(control())
        values[0] = 0.1

    under(register, instance.set_input_function, inputs)
    under(register, instance.run, 0.01, 5)
    assert visited == {register}
    return (*results, under(register, instance.save))


def test_the_bits_do_not_depend_on_the_caller() -> None:
    usual = bits(DEFAULT)
    assert len(set(usual)) == 2
    for name, register in ODD.items():
        assert bits(register) == usual, name
