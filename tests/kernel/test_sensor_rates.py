"""Rates of sensors against differences; looking changes nothing."""

import numpy as np

import mbs
from mbs.kernel import binding
from mbs.kernel.binding.instance import Instance
from mbs.scenes import prototype_car
from tests.kernel.sensor_rates import RATE_ERROR, rates_of, slopes_of

H = 0.002


def test_rates_of_sensors() -> None:
    system = mbs.compile(prototype_car.build())
    instance = Instance(binding.LoadedSystem(system.to_bytes()))
    for i, value in enumerate([0.2, 0.3, 0.0]):
        instance.set_input(i, value)
    instance.set_pose(0.0, 0.0, 0.0, 0.4, 15.0)
    instance.initialise()
    instance.run(H, 100)
    instance.set_settings(tolerance_r=1e-13, tolerance_phi=1e-12)
    before = instance.save()
    actual, chosen = rates_of(instance)
    assert instance.save() == before
    slopes = slopes_of(instance)
    names = [s["name"] for s, k in zip(system.meta["sensors"], chosen, strict=True) if k]
    assert {"chassis.x", "chassis.yaw", "chassis.qw", "chassis.vx", "speed", "wheel_FL.steer"} <= set(names)
    assert not {"chassis.ax", "wheel_FL.Fz", "solver.iterations"} & set(names)
    assert np.allclose(actual[chosen], slopes[chosen], rtol=RATE_ERROR, atol=RATE_ERROR)
    assert np.max(np.abs(actual[chosen])) > 1.0
    assert np.all(actual[~chosen] == 0.0)
