"""Shapes of a wheel carrier: hub, arms to its joints, steering arm."""

from __future__ import annotations

from collections.abc import Sequence

from mbs.model.body import Body
from mbs.vehicle.shapes.appearance import CAST_STEEL, Anchor, Looks, inboard
from mbs.vehicle.side import Side

HUB_SIZE = 0.055, 0.030  # m: length and radius of the hub of a small car
BEARING_LENGTH = 0.02  # m: length of the hub that is drawn beside the wheel centre
ARM_RADIUS, STEERING_ARM_RADIUS = 0.020, 0.013  # m


def draw_knuckle(looks: Looks, side: Side, carrier: Body, joints: Sequence[Anchor], arm: Anchor | None) -> None:
    """Draw hub and arms on the carrier; the shape of the wheel includes the brake disc.

    `joints`: joints of the carrier, from the lowest to the highest; `arm`: outer end of the rod that steers it.
    """
    axle = getattr(looks.car, side.axle)
    centre = side.point(axle.wheel.centre)
    length, radius = (looks.scale * size for size in HUB_SIZE)
    hub = inboard(centre, length)
    below = [joint for joint in joints if joint[1][2] <= hub[2]]
    above = [joint for joint in joints if joint[1][2] > hub[2]]
    # one tube from the lowest joint through the hub to the highest one
    looks.tube(*below, (carrier, hub), *above, radius=ARM_RADIUS, **CAST_STEEL)
    looks.cylinder(carrier, (inboard(hub, BEARING_LENGTH), centre), radius)
    if arm is not None:
        looks.tube((carrier, hub), arm, radius=STEERING_ARM_RADIUS, **CAST_STEEL)
