"""Notes on wheel travel beyond the stops of an axle."""

import numpy as np
from scipy.interpolate import PchipInterpolator

from mbs.vehicle.kinematics.curves import Curve
from mbs.vehicle.linkages.linkage import Linkage


def stop_notes(linkage: Linkage, parallel: Curve) -> list[str]:
    """Sentences on the travel at which the stops become metal on metal, if a curve exceeds it.

    `parallel`: curve of parallel wheel travel.
    """
    stops = linkage.data.stops
    if stops is None:
        return []
    notes = []
    for name, end, compression in (
        ("bump", 1.0, stops.bump_gap + stops.bump_travel),
        ("rebound", -1.0, stops.rebound_gap + stops.rebound_travel),
    ):
        travel = travel_of_compression(parallel, end * compression)
        last = float(parallel["wheel_travel_left"][-1 if end > 0.0 else 0])
        if not np.isnan(travel):
            notes.append(
                f"{linkage.name} axle: the range goes to {1e3 * last:+.1f} mm of wheel travel, but from "
                f"{1e3 * travel:+.1f} mm on the {name} stops are metal on metal; what lies beyond is geometry only."
            )
    return notes


def travel_of_compression(parallel: Curve, compression: float) -> float:
    """Wheel travel at a compression of the spring from the drawing, m; NaN: it is not on the curve.

    `parallel`: curve of parallel wheel travel; `compression`: m, negative in extension.
    """
    compressed = parallel.drawn()["spring_length_left"] - parallel["spring_length_left"]
    rising, first = np.unique(compressed, return_index=True)
    travel = PchipInterpolator(rising, parallel["wheel_travel_left"][first], extrapolate=False)
    return float(travel(compression))
