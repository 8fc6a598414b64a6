"""Largest travel of wheels and steering that the links of an axle allow without stops."""

from collections.abc import Iterator

import numpy as np

from mbs.vehicle.car_content import CarContent
from mbs.vehicle.linkages.continuation import HEAVE, STEER, reached
from mbs.vehicle.linkages.linkage import Array, Linkage, Position
from mbs.vehicle.suspensions.curve_table import RACK
from mbs.vehicle.suspensions.curves import Curves

FARTHEST = 0.5  # m: travel of wheels and rack that is looked at


def notes_without_stops(car: CarContent) -> Iterator[str]:
    """A sentence for each axle without stops, and one for a steered knuckle without.

    `car`: at rest near the drawing.
    """
    yield from _missing_stops(car)
    yield from _missing_steering_stop(car)


def _missing_stops(car: CarContent) -> Iterator[str]:
    for name, axle in car.axles.items():
        if axle.stops is not None:
            continue
        if isinstance(axle.suspension, Curves):
            curves, travel = axle.suspension, axle.suspension.table.travel
            yield (
                f"{axle.key('stops')} is missing: only the spring limits the travel of the {name} wheels, and "
                f"{curves.key('file')} ({curves.file}) goes from {travel[0]:+.3f} to {travel[-1]:+.3f} "
                "m of wheel travel from the drawing; a run ends beyond. Add stops that act before that."
            )
            continue
        linkage = Linkage(car, name)
        ends = _ends(linkage, HEAVE)
        if ends is None:
            continue
        yield (
            f"{axle.key('stops')} is missing: only the spring limits the travel of the {name} wheels, and the "
            f"links follow from {ends[0]:+.3f} to {ends[1]:+.3f} m of wheel travel from the drawing; beyond, a run "
            "fails where they would part. Add stops that act before that."
        )


def _missing_steering_stop(car: CarContent) -> Iterator[str]:
    stop, steering = car.front.suspension.stop_left_out, car.steering
    if not stop:
        return
    linkage = Linkage(car, "front")
    notes = []
    if steering.motion == RACK and (ends := _ends(linkage, STEER)):
        notes.append(
            f"{ends[0]:+.3f} to {ends[1]:+.3f} m of the rack ({steering.lateral_travel[0]} is {steering.full:g})"
        )
    at_lock, lock = reached(linkage, STEER, np.array([steering.full]))
    if lock is None and (ends := _ends(linkage, HEAVE, at_lock[0])):
        notes.append(f"{ends[0]:+.3f} to {ends[1]:+.3f} m of wheel travel at full lock")
    if notes:
        yield (
            f"{stop} is missing: nothing keeps a knuckle from turning over, and the links "
            f"of the front axle follow {' and '.join(notes)}; beyond, a run fails where they would part. Add a stop "
            "that acts before that."
        )


def _ends(linkage: Linkage, direction: Array, start: Position | None = None) -> tuple[float, float] | None:
    """Travel to both sides of a start up to which the links follow, m; None if it is `FARTHEST` on both sides."""
    low, high = (reached(linkage, direction, np.array([far]), start)[1] for far in (-FARTHEST, FARTHEST))
    if low is None and high is None:
        return None
    return -FARTHEST if low is None else low, FARTHEST if high is None else high
