"""How far the links of an axle without stops let its wheels go."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from mbs.vehicle.car import Car
from mbs.vehicle.linkages.continuation import HEAVE, reached
from mbs.vehicle.linkages.linkage import Linkage

FARTHEST = 0.5  # m: wheel travel that is looked at


def notes_without_stops(car: Car) -> Iterator[str]:
    """A sentence for each axle without stops.

    Parameters
    ----------
    car : Car
        At rest near the drawing.
    """
    for name, axle in (("front", car.front), ("rear", car.rear)):
        if axle.stops is not None:
            continue
        if axle.by_curves is not None:
            travel = axle.by_curves.table.travel
            yield (
                f"{axle.key('stops')} is left out: nothing but the spring ends the travel of the {name} wheels, and "
                f"{axle.by_curves.key('file')} ({axle.by_curves.file}) goes from {travel[0]:+.3f} to {travel[-1]:+.3f} "
                "m of wheel travel from the drawing; a run ends beyond. Stops that bear before that keep it within."
            )
            continue
        linkage = Linkage(car, name)
        ends = [reached(linkage, HEAVE, np.array([far]))[1] for far in (-FARTHEST, FARTHEST)]
        if ends == [None, None]:
            continue
        low, high = (
            f"{far if end is None else end:+.3f}" for end, far in zip(ends, (-FARTHEST, FARTHEST), strict=True)
        )
        yield (
            f"{axle.key('stops')} is left out: nothing but the spring ends the travel of the {name} wheels, and the "
            f"links follow from {low} to {high} m of wheel travel from the drawing; beyond, a run fails where they "
            "would part. Stops that bear before that keep it together."
        )
