"""Wheel travel at the beginning and the end of the stops of an axle."""

import numpy as np
from scipy.interpolate import PchipInterpolator

from mbs.vehicle.kinematics.curves import Curve
from mbs.vehicle.linkages.linkage import Linkage


def stop_notes(linkage: Linkage, parallel: Curve) -> list[str]:
    """Sentences where the range of a curve goes beyond where the stops are metal on metal.

    `parallel`: over parallel travel.
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

    `parallel`: over parallel travel; `compression`: in m, negative where the spring is longer.
    """
    compressed = parallel.drawn()["spring_length_left"] - parallel["spring_length_left"]
    rising, first = np.unique(compressed, return_index=True)
    travel = PchipInterpolator(rising, parallel["wheel_travel_left"][first], extrapolate=False)
    return float(travel(compression))
