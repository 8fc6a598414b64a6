"""Where the stops of an axle's springs begin and end, in wheel travel, and how far its links follow without them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.interpolate import PchipInterpolator

from mbs.vehicle.car import Car
from mbs.vehicle.kinematics.curves import DIRECTIONS, Curve, reached
from mbs.vehicle.kinematics.linkage import Linkage

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
        linkage = Linkage(car, name)
        ends = [reached(linkage, DIRECTIONS["parallel"], np.array([far]))[1] for far in (-FARTHEST, FARTHEST)]
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


def stop_notes(linkage: Linkage, parallel: Curve) -> list[str]:
    """Sentences where the range of a curve goes beyond where the stops are metal on metal.

    Parameters
    ----------
    parallel : Curve
        Over parallel travel.
    """
    stops = linkage.data.stops
    if stops is None:
        return []
    notes = []
    for name, end, compression in (
        ("bump", 1.0, stops.bump_gap + stops.bump_travel),
        ("rebound", -1.0, stops.rebound_gap + stops.rebound_travel),
    ):
        travel = travel_at(parallel, end * compression)
        last = float(parallel["wheel_travel_left"][-1 if end > 0.0 else 0])
        if not np.isnan(travel):
            notes.append(
                f"{linkage.name} axle: the range goes to {1e3 * last:+.1f} mm of wheel travel, but from "
                f"{1e3 * travel:+.1f} mm on the {name} stops are metal on metal; what lies beyond is geometry only."
            )
    return notes


def travel_at(parallel: Curve, compression: float) -> float:
    """Wheel travel at which the spring is shorter than drawn by a compression, m; NaN: not on the curve.

    Parameters
    ----------
    parallel : Curve
        Over parallel travel.
    compression : float
        m, negative where the spring is longer.
    """
    compressed = parallel.drawn()["spring_length_left"] - parallel["spring_length_left"]
    rising, first = np.unique(compressed, return_index=True)
    travel = PchipInterpolator(rising, parallel["wheel_travel_left"][first], extrapolate=False)
    return float(travel(compression))
