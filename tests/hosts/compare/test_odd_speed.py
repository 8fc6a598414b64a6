"""A speed in another unit, which the log tells by itself; one that falls where that of the simulation rises."""

from __future__ import annotations

import numpy as np
import pytest

from hosts.compare.log import Signal
from hosts.compare.plausibility import odd_scale, odd_speed


@pytest.mark.parametrize(("factor", "told"), [(1.0, False), (3.6, True), (2.0, False), (1.0 / 3.6, False)])
def test_the_lateral_acceleration_tells_the_unit_of_the_speed(factor: float, told: bool) -> None:
    noise = np.random.default_rng(2)
    t = np.arange(0.0, 6.0, 0.01)
    speed, yaw = 15.0 + 0.5 * t, 0.3 * np.sin(2.5 * t)
    measured = {
        "speed": Signal("speed", "v", "m/s", t, factor * speed),
        "chassis.wz": Signal("chassis.wz", "gyro", "rad/s", t, yaw + 0.01 * noise.normal(size=len(t))),
        "chassis.ay": Signal("chassis.ay", "acc", "m/s2", t, speed * yaw + 0.2 * noise.normal(size=len(t))),
    }
    words = odd_speed(measured)
    assert ("'v' (speed)" in words and 'unit = "km/h"' in words) if told else not words


@pytest.mark.parametrize("turned", [False, True])
def test_a_speed_that_falls_where_the_simulated_rises_has_no_other_sign(turned: bool) -> None:
    t = np.arange(0.0, 6.0, 0.01)
    measured = Signal("speed", "v", "m/s", t, -15.0 - t if turned else 15.0 - t)
    assert ("factor = -1.0" in odd_scale(measured, lambda when: 15.0 + when)) == turned
