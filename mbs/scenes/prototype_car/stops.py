"""Bump and rebound stops of the springs.

The paper mentions none and its kerb does not reach them. Without them a car at full lock, or one that falls, moves its
suspension far beyond any real travel, until the links turn over into their other assembly.

All numbers are assumed. A microcellular bump stop on the damper's rod begins softly, is four times as stiff after
BUMP_PROGRESSION and ends after BUMP_TRAVEL where its housing meets the damper's body, metal on metal. The rebound stop
inside the damper is the same, shorter: at full lock the tie rod passes its dead centre 0.18 m below the drawn place of
the wheel, and an overturned wheel is pulled out as hard as an upright one is pushed in. A blow of 1 m/s leaves either
stop at 0.65 m/s. Normal driving stays on the soft part, where the stops are as stiff as their predecessors.
"""

from __future__ import annotations

import math

from mbs.elements.spring_damper import EndStops
from mbs.scenes.prototype_car.side import Point

BUMP_GAP = {"front": 0.070, "rear": 0.075}  # m of spring length from the drawing to the stop
REBOUND_GAP = 0.085  # m, likewise
STIFFNESS = 80.0e3  # N/m, where a stop begins
BUMP_PROGRESSION, BUMP_TRAVEL = 0.020, 0.035  # m
REBOUND_PROGRESSION, REBOUND_TRAVEL = 0.010, 0.006  # m
METAL_STIFFNESS, METAL_ONSET = 10.0e6, 0.003  # N/m, m
LOSS = 1.0  # s/m
STEERING_LENGTH = 0.296  # m from the outer end of the tie rod to the front pivot of the lower wishbone: 0.72 rad
STEERING_STIFFNESS, STEERING_TRAVEL = 400.0e3, 0.004  # N/m, m


def steering_stop() -> EndStops:
    """The stop of the knuckle on the lower wishbone, as a bump stop between the two points above.

    Rack and wheel travel within the end stops stay clear of it; pulled out at full lock the knuckle would turn over.
    """
    return EndStops(
        STEERING_LENGTH,
        STEERING_STIFFNESS,
        bump_travel=STEERING_TRAVEL,
        metal_stiffness=METAL_STIFFNESS,
        metal_onset=METAL_ONSET,
        bump_loss=LOSS,
    )


def end_stops(axle: str, lower: Point, upper: Point) -> EndStops:
    """Stops of the spring drawn between two points, m."""
    drawn = math.dist(lower, upper)
    return EndStops(
        drawn - BUMP_GAP[axle],
        STIFFNESS,
        drawn + REBOUND_GAP,
        STIFFNESS,
        bump_progression=BUMP_PROGRESSION,
        bump_travel=BUMP_TRAVEL,
        rebound_progression=REBOUND_PROGRESSION,
        rebound_travel=REBOUND_TRAVEL,
        metal_stiffness=METAL_STIFFNESS,
        metal_onset=METAL_ONSET,
        bump_loss=LOSS,
        rebound_loss=LOSS,
    )
