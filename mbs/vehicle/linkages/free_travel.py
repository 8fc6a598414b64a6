"""Travel of wheels and steering that the links of an axle allow without stops."""

from collections.abc import Iterator

import numpy as np

from mbs.vehicle.car_content import CarContent
from mbs.vehicle.linkages.continuation import HEAVE, STEER, positions_along
from mbs.vehicle.linkages.linkage import Array, Linkage, Position
from mbs.vehicle.suspensions.curve_table import RACK
from mbs.vehicle.suspensions.curves import Curves

MAX_TRAVEL = 0.5  # m, of wheels and rack, that is examined


def notes_without_stops(car: CarContent) -> Iterator[str]:
    """Yield a sentence for each axle without stops, and one for a steered knuckle without a stop.

    `car`: a car at rest near the drawing.
    """
    yield from _stop_notes(car)
    yield from _steering_stop_notes(car)


def _stop_notes(car: CarContent) -> Iterator[str]:
    """Yield a sentence for each axle without stops."""
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
        ends = _travel_limits(linkage, HEAVE)
        if ends is None:
            continue
        yield (
            f"{axle.key('stops')} is missing: only the spring limits the travel of the {name} wheels, and the "
            f"links follow from {ends[0]:+.3f} to {ends[1]:+.3f} m of wheel travel from the drawing; beyond, a run "
            "fails where they would part. Add stops that act before that."
        )


def _steering_stop_notes(car: CarContent) -> Iterator[str]:
    """Yield a sentence if a steered knuckle has no stop and the links limit its travel."""
    stop, steering = car.front.suspension.stop_left_out, car.steering
    if not stop:
        return
    linkage = Linkage(car, "front")
    notes = []
    if steering.motion == RACK and (ends := _travel_limits(linkage, STEER)):
        notes.append(
            f"{ends[0]:+.3f} to {ends[1]:+.3f} m of the rack ({steering.lateral_travel[0]} is {steering.full:g})"
        )
    lock_positions, limit = positions_along(linkage, STEER, np.array([steering.full]))
    if limit is None and (ends := _travel_limits(linkage, HEAVE, lock_positions[0])):
        notes.append(f"{ends[0]:+.3f} to {ends[1]:+.3f} m of wheel travel at full lock")
    if notes:
        yield (
            f"{stop} is missing: nothing keeps a knuckle from turning over, and the links "
            f"of the front axle follow {' and '.join(notes)}; beyond, a run fails where they would part. Add a stop "
            "that acts before that."
        )


def _travel_limits(linkage: Linkage, direction: Array, start: Position | None = None) -> tuple[float, float] | None:
    """Limits of the travel from a start by the links, m; None if they are beyond `MAX_TRAVEL` on both sides."""
    low, high = (
        positions_along(linkage, direction, np.array([travel]), start)[1] for travel in (-MAX_TRAVEL, MAX_TRAVEL)
    )
    if low is None and high is None:
        return None
    return -MAX_TRAVEL if low is None else low, MAX_TRAVEL if high is None else high
