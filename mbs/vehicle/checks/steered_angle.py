"""Travel of the rack against the angle of the wheels that the file gives."""

from __future__ import annotations

import math
from collections.abc import Iterator

from mbs.vehicle.car_content import CarContent
from mbs.vehicle.steering.rack_by_angle import RackByAngle
from mbs.vehicle.steering.rack_table import SAME

FACTOR = 1.6  # the estimate leaves out the angle of the tie rods and the inclination of the steering axis
CURVES_MISS = 0.1  # of the angle: a table says it, but for what both wheels differ


def steering_oddities(car: CarContent) -> Iterator[str]:
    """Sentences where a table is stretched, and where the angle at full travel is not that of the rack on its arms or
    of the table of its axle."""
    table = car.steering.by_table if isinstance(car.steering, RackByAngle) else None
    if isinstance(car.steering, RackByAngle) and table is not None and abs(table.factor - 1.0) > SAME:
        turn = 2.0 * math.pi * table.slope
        yield (
            f"{car.steering.key('rack_by_wheel_angle')} has {turn:.6g} m of rack travel per turn straight ahead, and "
            f"{car.steering.key('rack_per_turn')} is {car.steering.rack_per_turn:g} m; the angles of the table are "
            f"divided by {table.factor:.6g}. To have them as they are write {turn:.6g}."
        )
    given, angle_key = car.steering.front_wheel_angle_max, car.steering.key("front_wheel_angle_max")
    curves = car.front.by_curves
    if curves is not None:
        found = curves.steered_angle(car.steering.full)
        if abs(found - given) > CURVES_MISS * given:
            yield (
                f"{angle_key} is {given:g} rad, but at full travel of the rack, {car.steering.full:.3g} m, the wheels "
                f"of {curves.key('file')} ({curves.file}) are turned by {found:.3g} rad; are the units of its headings "
                "right?"
            )
    arm = getattr(car.front.suspension, "steering_arm", None)
    if arm is None:
        return
    key, travel = car.steering.lateral_travel
    length = abs(arm[0] - car.front.wheel.centre[0])
    about = math.asin(min(1.0, travel / max(length, 1e-3)))
    if not about / FACTOR <= given <= about * FACTOR:
        yield (
            f"{angle_key} is {given:g} rad, but {key}, {travel:.3g} m to the side, on a steering arm {length:.3g} m "
            f"long gives about {about:.2g} rad."
        )
