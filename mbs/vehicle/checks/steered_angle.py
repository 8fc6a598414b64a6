"""Travel of the rack against the angle of the wheels that the file gives."""

from __future__ import annotations

import math
from collections.abc import Iterator

from mbs.vehicle.car_content import CarContent

FACTOR = 1.6  # the estimate leaves out the angle of the tie rods and the inclination of the steering axis


def steering_oddities(car: CarContent) -> Iterator[str]:
    """A sentence where the angle at full travel is not that of the rack on the steering arms.

    Parameters
    ----------
    car : CarContent
        Without faults.
    """
    arm = getattr(car.front.suspension, "steering_arm", None)
    travel = getattr(car.steering, "rack_travel", None)
    if arm is None or travel is None:
        return
    length = abs(arm[0] - car.front.wheel.centre[0])
    about = math.asin(min(1.0, travel / max(length, 1e-3)))
    given = car.steering.front_wheel_angle_max
    if not about / FACTOR <= given <= about * FACTOR:
        yield (
            f"{car.steering.key('front_wheel_angle_max')} is {given:g} rad, but {car.steering.key('rack_travel')} of "
            f"{travel:g} m on a steering arm {length:.3g} m long gives about {about:.2g} rad."
        )
