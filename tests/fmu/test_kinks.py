"""Directional derivatives of steps in which a force law passes a kink: there are none, and the element is named."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from tests.fmu.calls import ERROR, OK, HostMaker

SIZE = 80.0  # of the range of the push
PART = 3e-4  # of a range, to each side
STEP = 0.004  # s, of communication
RAILS = {
    "buffered": ("buffer", lambda t: -12.0 + 14.0 * math.sin(9.0 * t), lambda d: d.get("mass.x") < 0.4),
    "held_by_friction": ("friction", lambda t: 14.0 * math.sin(5.0 * t), lambda d: d.get("sticks")),
}


def _sides(driven: Any, unknown: list[int], name: str, value: float, size: float, time: float, step: float) -> Any:
    """Differences of a step by an input, from above and from below; the state stays."""
    state, ends = driven.slave.getFMUstate(), []
    for side in (1.0, 0.0, -1.0):
        driven.slave.setFMUstate(state)
        driven.set(name, value + side * PART * size)
        assert driven.step(time, step) == OK
        ends.append(np.array(driven.slave.getReal(unknown)))
    driven.slave.setFMUstate(state)
    return (ends[0] - ends[1]) / (PART * size), (ends[1] - ends[2]) / (PART * size)


def _derivative(driven: Any, unknown: list[int], name: str) -> list[float] | str:
    """Or the words with which it is refused."""
    end, known = driven.outputs(), [driven.references[name]]
    status = driven.call("getDirectionalDerivative", unknown, known, [1.0])
    assert driven.outputs() == end
    if status == OK:
        return list(driven.slave.getDirectionalDerivative(unknown, known, [1.0]))
    assert status == ERROR
    assert "There is no directional derivative" in driven.messages[-1]
    return str(driven.messages[-1])


@pytest.mark.parametrize(("name", "inner"), [("buffered", 4), ("held_by_friction", 1)])
def test_steps_that_pass_a_kink(name: str, inner: int, build: Callable[..., Path], host: HostMaker) -> None:
    """A stop that is met and left, friction that slips and sticks: refused there, elsewhere that of both sides."""
    element, push, piece = RAILS[name]
    driven = host(build(name)).start({"step_size": STEP / inner})
    unknown = [driven.references[n] for n in ("mass.x", "mass.vx", "mass.ax")]
    before, refused = piece(driven), 0
    for k in range(400):
        value = push(k * STEP)
        above, below = _sides(driven, unknown, "push", value, SIZE, k * STEP, STEP)
        driven.set("push", value)
        assert driven.step(k * STEP, STEP) == OK
        actual, passes, before = _derivative(driven, unknown, "push"), piece(driven) != before, piece(driven)
        if passes:
            assert isinstance(actual, str)
            assert f"'{element}' passes a kink of its law: a stop" in actual
            refused += 1
        else:
            assert np.allclose(actual, above, rtol=1e-4)
            assert np.allclose(actual, below, rtol=1e-4)
    assert refused >= 4


@pytest.mark.parametrize(("name", "less"), [("buffered", 0.5), ("held_by_friction", -0.5)])
def test_both_sides_of_a_kink(name: str, less: float, build: Callable[..., Path], host: HostMaker) -> None:
    """A step that ends at the kink itself: what comes from above is far from what comes from below."""
    element, push, piece = RAILS[name]
    driven = host(build(name)).start({"step_size": STEP})
    start, before, last = driven.slave.getFMUstate(), piece(driven), 0

    def step(k: int, more: float) -> None:
        driven.set("push", push(k * STEP) + more)
        assert driven.step(k * STEP, STEP) == OK

    while piece(driven) == before:
        step(last, 0.0)
        last += 1

    def side(more: float) -> float:
        driven.slave.setFMUstate(start)
        for k in range(last):
            step(k, more)
        return 1.0 if piece(driven) == before else -1.0

    at = brentq(side, 0.0, less, xtol=1e-12)
    driven.slave.setFMUstate(start)
    for k in range(last - 1):
        step(k, at)
    above, below = _sides(
        driven, [driven.references["mass.ax"]], "push", push((last - 1) * STEP) + at, SIZE, (last - 1) * STEP, STEP
    )
    assert abs(above[0] - below[0]) > 0.1 * max(abs(above[0]), abs(below[0]))
    step(last - 1, at)
    assert f"'{element}' passes a kink" in str(_derivative(driven, [driven.references["mass.ax"]], "push"))


@pytest.mark.slow
def test_a_car_at_the_limits_of_its_motor(prototype_fmu: Path, host: HostMaker) -> None:
    """The step in which the engine reaches its power has no derivative by the throttle; all but one other have."""
    driven = host(prototype_fmu).start({"initial.speed": 2.0})
    unknown, names = [driven.references["chassis.ax"]], ("drive.max_power", "drive.max_torque", "engine_speed")
    full, most, rate = (driven.get(n) for n in names)
    refused, reached = [], -1
    for k in range(200):
        driven.set("throttle", min(0.9, 0.02 * (k + 1)))
        assert driven.step(k * 0.01, 0.01) == OK
        before, rate = rate, driven.get("engine_speed")
        if before <= full / most < rate:
            reached = k
        if isinstance(result := _derivative(driven, unknown, "throttle"), str):
            refused.append(k)
            assert "'drive' passes a kink" in result
    assert reached in refused
    assert len(refused) == 2  # the other: the converter couples
