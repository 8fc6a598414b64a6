"""Parameters of a car's FMU that change how far its steering wheel turns to full lock, and constants beside them."""

import math
from collections.abc import Mapping

from hosts.common.numbers import Value
from hosts.fmu.variables import Variables

RATIOS = {"steering.rack_per_turn": -1.0, "steering.ratio": 1.0}
"""By name the power with which the angle at full lock goes: travel of the rack per turn, ratio of a steering box."""
_BY_RATIO = ("vehicle.steering_wheel_angle_max", "vehicle.steering_ratio")


def steering_as_set(constants: Mapping[str, float], table: Variables, start: Mapping[str, Value]) -> dict[str, float]:
    """Constants of the steering where another ratio is set: full lock is a place of the rack or the arm.

    `constants`: of the FMU, which keeps those of the car file. Result: empty where the ratio is that of the car file.
    """
    scale = 1.0
    for name, power in RATIOS.items():
        if name in start:
            scale *= (float(start[name]) / float(table[name].start or math.nan)) ** power
    return {name: scale * constants[name] for name in _BY_RATIO if scale != 1.0 and name in constants}


def steering_rows(table: Variables, start: Mapping[str, Value]) -> list[tuple[str, str]]:
    """What a summary says of these constants: the FMU does not know that they have changed."""
    of_file = {n: float(table[n].start or math.nan) for n in _BY_RATIO if n in table.names}
    return [
        (name, f"constant {of_file[name]:.6g} of the FMU is that of the car file; as set it is {value:.6g}")
        for name, value in steering_as_set(of_file, table, start).items()
    ]
