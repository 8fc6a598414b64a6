"""Variable steering ratio: travel of the rack as a table of the angle of the steering wheel."""

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

from mbs.vehicle.quantities import RackMillimetres, SteeringWheelDegrees

Rows: TypeAlias = tuple[tuple[SteeringWheelDegrees, RackMillimetres], ...]
SLOPE_TOLERANCE = 1e-3
"""Relative difference between the slope of the table straight ahead and the travel per turn that is not reported."""


class RackTable:
    """Travel of the rack as an odd function of the angle of the steering wheel.

    It is a monotone cubic between the rows, with angles scaled so that its slope straight ahead is the travel per turn
    of the file or of the parameter.

    `rows`: angle, deg, and travel, mm, of one side from (0, 0), without faults; `per_radian`: travel per radian
    straight ahead, m/rad.
    """

    def __init__(self, rows: Rows, per_radian: float) -> None:
        side = np.array(rows) * (math.pi / 180.0, 1e-3)
        self.rows: NDArray[np.float64] = np.concatenate([-side[:0:-1], side])
        """Angle, rad, and travel, m, of both sides, unscaled, shape (n, 2)."""
        self._curve = PchipInterpolator(*self.rows.T)
        self.slope = float(self._curve(0.0, 1))
        """Travel per radian straight ahead in the table, m/rad."""
        self.factor = per_radian / self.slope
        """Angle in the table divided by the angle of the steering wheel."""

    def angle(self, travel: float) -> float:
        """Angle in the table at a travel of the rack, rad; linear beyond the last row. `travel`: m."""
        x, y = self.rows.T
        if abs(travel) >= y[-1]:
            return math.copysign(float(x[-1] + (abs(travel) - y[-1]) / self._curve(x[-1], 1)), travel)
        k = int(np.searchsorted(y, travel, side="right")) - 1
        if y[k] == travel:
            return float(x[k])
        return float(brentq(lambda u: float(self._curve(u)) - travel, x[k], x[k + 1], xtol=1e-15, rtol=1e-15))

    def at(self, travel: float) -> tuple[float, float]:
        """Angle of the steering wheel, rad, and its derivative by the travel of the rack, rad/m. `travel`: m."""
        angle = self.angle(travel)
        return angle / self.factor, 1.0 / (self.factor * float(self._curve(angle, 1)))


def table_faults(key: str, rows: Rows, travel_key: str, travel: float) -> Iterator[str]:
    """Yield a sentence for a fault of a table. `travel_key`, `travel`: key path and value of the travel at full lock,
    m."""
    if len(rows) < 2:
        yield f"{key} has {len(rows)} rows; it must have two or more."
        return
    if rows[0] != (0.0, 0.0):
        yield (
            f"{key}.0 is {list(rows[0])}; the first row must be [0, 0], straight ahead, and the others those of one "
            "side, which the other one mirrors."
        )
        return
    for k, (first, second) in enumerate(pairwise(rows)):
        if second[0] <= first[0] or second[1] <= first[1]:
            yield (
                f"{key}.{k + 1} is {list(second)} after {list(first)}; both columns must rise from row to row, angle "
                "in deg and travel in mm."
            )
            return
    if rows[-1][1] < 1e3 * travel * (1.0 - 1e-12):
        yield (
            f"{key} ends at {rows[-1][1]:g} mm of rack travel, {rows[-1][0]:g} deg; it must reach to {travel_key}, "
            f"{1e3 * travel:g} mm."
        )
