"""Rates of sensors against differences; looking changes nothing."""

from __future__ import annotations

import ctypes

import numpy as np

import mbs
from mbs.kernel import binding
from mbs.kernel.binding.instance import Instance
from mbs.scenes import prototype_car

RATE_ERROR, H, RATE_STEP = 2e-3, 0.002, 1e-5


def test_rates_of_sensors() -> None:
    system = mbs.compile(prototype_car.build())
    instance = Instance(binding.LoadedSystem(system.to_bytes()))
    for i, value in enumerate([0.2, 0.3, 0.0]):
        instance.set_input(i, value)
    instance.set_pose(0.0, 0.0, 0.0, 0.4, 15.0)
    instance.initialise()
    instance.run(H, 100)
    instance.set_settings(tolerance_r=1e-13, tolerance_phi=1e-12)
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
