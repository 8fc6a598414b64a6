"""Signs and units of a car's signals, seen in a slow turn: an alias file may have them wrong."""

from __future__ import annotations

import math

import numpy as np

from hosts.catalogue.steered_run import SteeredRun

_ENOUGH = 0.5
_NEAR = (0.7, 1.4)


def implausible(run: SteeredRun) -> str | None:
    """What cannot be in a turn of slowly rising steering; None if all can.

    Returns a sentence. In such a turn the car accelerates and turns to the side of the steering, and its lateral
    acceleration is near speed times yaw rate.
    """
    if len(run.time) < 20:
        return None
    size = np.abs(run.acceleration)
    k = int(np.argmax(size >= 0.8 * size.max()))
    steering, yaw_rate, acceleration = (float(x[k]) for x in (run.steering, run.yaw_rate, run.acceleration))
    if not size[k] >= _ENOUGH:
        return None
    side = "left" if steering > 0.0 else "right"
    for word, value, names in (
        ("lateral acceleration", acceleration, "chassis.ay"),
        ("yaw rate", yaw_rate, "chassis.wz"),
    ):
        if value * steering < 0.0:
            return (
                f"With the steering wheel to the {side} the {word} is to the other side: a sign is wrong, of the "
                f"steering or of {names}, left is positive; an alias file gives it by factor = -1."
            )
    expected = float(run.speed[k]) * yaw_rate
    ratio = acceleration / expected if expected else math.inf
    if not _NEAR[0] < ratio < _NEAR[1]:
        return (
            f"In a slow turn the lateral acceleration is {acceleration:.3g} m/s² where speed times yaw rate is "
            f"{expected:.3g} m/s²: a unit is wrong, of chassis.ay (m/s²), chassis.wz (rad/s) or speed (m/s); an alias "
            "file gives it by factor."
        )
    return None
