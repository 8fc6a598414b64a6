"""Constants of the steering of a car whose ratio a parameter changes."""

import math
from collections.abc import Mapping

from hosts.common.numbers import Value
from hosts.fmu.variables import Variables

RATIOS = {"steering.rack_per_turn": -1.0, "steering.ratio": 1.0}
"""Parameters with the power of them to which the steering wheel angle at full lock is proportional."""
_BY_RATIO = ("vehicle.steering_wheel_angle_max", "vehicle.steering_ratio")


def steering_as_set(constants: Mapping[str, float], table: Variables, start: Mapping[str, Value]) -> dict[str, float]:
    """Constants of the steering with the ratio that is set; the rack or arm keeps its position at full lock.

    `constants`: constants of the FMU, as in the car file. Result: empty if the car file has this ratio.
    """
    scale = 1.0
    for name, power in RATIOS.items():
        if name in start:
            scale *= (float(start[name]) / float(table[name].start or math.nan)) ** power
    return {name: scale * constants[name] for name in _BY_RATIO if scale != 1.0 and name in constants}


def steering_rows(table: Variables, start: Mapping[str, Value]) -> list[tuple[str, str]]:
    """Rows of a summary for changed constants, which the FMU does not update."""
    of_file = {n: float(table[n].start or math.nan) for n in _BY_RATIO if n in table.names}
    return [
        (name, f"constant {of_file[name]:.6g} of the FMU is that of the car file; as set it is {value:.6g}")
        for name, value in steering_as_set(of_file, table, start).items()
    ]
