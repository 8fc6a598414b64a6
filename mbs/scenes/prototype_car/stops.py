"""Bump and rebound stops of the springs.

The paper mentions none and its kerb does not reach them. Without them a car at full lock, or one that falls, moves its
suspension far beyond any real travel, until the links turn over into their other assembly.
"""

from __future__ import annotations

import math

from mbs.elements.spring_damper import EndStops
from mbs.scenes.prototype_car.car_data import BUMP_GAP, REBOUND_GAP, STOP_STIFFNESS
from mbs.scenes.prototype_car.side import Point


def end_stops(axle: str, lower: Point, upper: Point) -> EndStops:
    """Stops of the spring drawn between two points, m."""
    drawn = math.dist(lower, upper)
    return EndStops(drawn - BUMP_GAP[axle], STOP_STIFFNESS, drawn + REBOUND_GAP, STOP_STIFFNESS)
