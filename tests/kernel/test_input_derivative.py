"""Derivatives of a step by its inputs, and rates of sensors, against differences; looking changes nothing."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence

import numpy as np
import pytest
from numpy.typing import NDArray

import mbs
from mbs.kernel import binding
from mbs.scenes import prototype_car

# Differences over this part of an input, steps converged to this tolerance.
PART, TIGHT = 1e-3, 1e-13
ERROR, RATE_ERROR = 2e-4, 2e-3
# Beyond the vibrations of the flexible car, which the projected accelerations do not have, the derivative is no better.
FLEXIBLE_ERROR = 2e-3
H, RATE_STEP = 0.002, 1e-5
NAMES = ("steering", "throttle", "brake")


def prepared(u: Sequence[float], fidelity: int = 0) -> tuple[mbs.System, binding.Instance]:
    system = mbs.compile(prototype_car.build(fidelity=fidelity))
    instance = binding.Instance(binding.LoadedSystem(system.to_bytes()))
    for i, value in enumerate(u):
        instance.set_input(i, value)
    instance.set_pose(0.0, 0.0, 0.0, 0.4, 15.0)
    instance.initialise()
    for _ in range(100):
        instance.step(H)
    instance.set_settings(tolerance_r=TIGHT, tolerance_phi=1e-12)
    return system, instance


def derivative(instance: binding.Instance, direction: Sequence[float]) -> tuple[int, NDArray[np.float64]]:
    sizes = instance.system.sizes
    out = (ctypes.c_double * sizes.ns)()
    given = (ctypes.c_double * sizes.nu)(*direction)
    status = instance._library.ali3_input_derivative(instance._handle, given, out)
    return int(status), np.array(out[:])


@pytest.mark.parametrize("fidelity", [0, 1, 2, 3])
@pytest.mark.parametrize("which", range(3), ids=NAMES)
def test_of_a_step_of_the_car(which: int, fidelity: int) -> None:
    u = [0.2, 0.3, 0.1]
    system, instance = prepared(u, fidelity)
    before, ends = instance.save(), []
    for sign in (1.0, -1.0, 0.0):
        instance.restore(before)
        instance.set_input(which, u[which] + sign * PART)
        instance.step(H)
        ends.append(np.array(instance.sensors()[:]))
    expected = (ends[0] - ends[1]) / (2.0 * PART)
    present = instance.save()
    direction = [1.0 if i == which else 0.0 for i in range(3)]
    status, found = derivative(instance, direction)
    assert status == 0
    assert instance.save() == present
    error = FLEXIBLE_ERROR if fidelity > 1 else ERROR
    smooth = np.array([not s["name"].startswith("solver") for s in system.meta["sensors"]])
    units = np.array([s["unit"] for s in system.meta["sensors"]])
    for unit in set(units):
        same = smooth & (units == unit)
        scale = np.max(np.abs(expected[same]), initial=0.0)
        assert np.all(np.abs(found - expected)[same] <= error * scale + 1e-9), unit
    assert np.max(np.abs(expected[smooth])) > 10.0
    _, twice = derivative(instance, [-2.0 * d for d in direction])
    assert np.allclose(twice, -2.0 * found, rtol=1e-5, atol=1e-8 * np.max(np.abs(found)))


def test_before_a_step_there_is_none() -> None:
    _, instance = prepared([0.0, 0.0, 0.0])
    instance.reset()
    instance.initialise()
    assert derivative(instance, [1.0, 0.0, 0.0])[0] == binding.Status.NOT_INITIALISED
    assert derivative(instance, [np.nan, 0.0, 0.0])[0] == binding.Status.BAD_ARGUMENT


def test_rates_of_sensors() -> None:
    system, instance = prepared([0.2, 0.3, 0.0])
    ns = instance.system.sizes.ns
    rates, known = (ctypes.c_double * ns)(), ctypes.create_string_buffer(ns)
    before = instance.save()
    assert instance._library.ali3_sensor_rates(instance._handle, rates, known) == 0
    assert instance.save() == before
    first = np.array(instance.sensors()[:])
    instance.step(RATE_STEP)
    slopes = (np.array(instance.sensors()[:]) - first) / RATE_STEP
    chosen = np.frombuffer(known.raw[:ns], dtype=np.uint8) == 1
    names = [s["name"] for s, k in zip(system.meta["sensors"], chosen, strict=True) if k]
    assert {"chassis.x", "chassis.yaw", "chassis.qw", "chassis.vx", "speed", "wheel_FL.steer"} <= set(names)
    assert not {"chassis.ax", "wheel_FL.Fz", "solver.iterations"} & set(names)
    found = np.array(rates[:])
    assert np.allclose(found[chosen], slopes[chosen], rtol=RATE_ERROR, atol=RATE_ERROR)
    assert np.max(np.abs(found[chosen])) > 1.0
    assert np.all(found[~chosen] == 0.0)
