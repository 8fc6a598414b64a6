"""The signals of a log by ALi3 names, which of them are related, and the least values at which they are compared."""

from collections.abc import Mapping
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from ali3.plausibility import quantities_of
from hosts.common import wheels
from hosts.measures.signal import Signal

Array: TypeAlias = NDArray[np.float64]
Signals: TypeAlias = Mapping[str, Signal]
QUANTITIES = quantities_of("log")
SPEEDS = ("speed", "chassis.vx")
WHEELS = tuple(f"wheel_{w}.omega" for w in wheels.WHEELS)
PATH = ("chassis.x", "chassis.y")
STEERING = "steering_wheel_angle"
MIN_LATERAL_ACCELERATION = 0.6
"""Least standard deviation of a lateral acceleration that is compared, m/s2."""
MIN_LONGITUDINAL_ACCELERATION = 0.3
"""Least standard deviation of a longitudinal acceleration that is compared, m/s2."""
MIN_YAW_RATE = 0.03
"""Least standard deviation of a yaw rate that is compared, rad/s; of a steering-wheel angle in rad."""
MIN_SPEED = 2.0
"""Speed from which a car moves, m/s."""
_MIN_WHEEL_SPEED = 2.0  # rad/s: from it a wheel rolls
_STANDING = {  # standard deviations below which a car stands
    "chassis.ax": MIN_LONGITUDINAL_ACCELERATION,
    "chassis.ay": MIN_LATERAL_ACCELERATION,
    "chassis.wz": MIN_YAW_RATE,
    **dict.fromkeys(PATH, 0.5),  # m
}


def speed_of(signals: Signals) -> str | None:
    """Name of the speed of a log; None if it has none."""
    return next((n for n in SPEEDS if n in signals), None)


def stands(signals: Signals) -> bool:
    """Whether the signals beside the speed show that the car stands; False if there are none."""
    still = [float(np.std(signals[n].values)) < least for n, least in _STANDING.items() if n in signals]
    still += [float(np.abs(signals[n].values).max()) < _MIN_WHEEL_SPEED for n in WHEELS if n in signals]
    return bool(still) and all(still)


def columns_of(signals: Signals, *names: str) -> dict[str, str]:
    """Columns of the signals that a value follows from, by their names."""
    return {name: f"'{signals[name].source}'" for name in names if name in signals}


def interpolated(signal: Signal, time: Array) -> Array:
    """Values of a signal at other times, s, shape (n,)."""
    return np.asarray(np.interp(time, signal.time, signal.values))
