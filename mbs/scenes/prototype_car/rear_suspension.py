"""Rear suspension: lower arm, strut fixed in the upright, toe link."""

from __future__ import annotations

import numpy as np

from mbs.model import Model
from mbs.model.body import Body
from mbs.scenes.prototype_car.car_data import REAR, REAR_BODIES, REAR_SPRING
from mbs.scenes.prototype_car.side import Side
from mbs.scenes.prototype_car.stops import end_stops


def rear_suspension(m: Model, chassis: Body, side: Side) -> Body:
    """Add one side and return its upright, the carrier of the wheel."""
    w = side.wheel
    p = {name: side.point(point) for name, point in REAR.items()}
    arm = side.body(m, "lower arm", REAR_BODIES["lower_arm"])
    upright = side.body(m, "upright", REAR_BODIES["upright"])
    for end in ("front", "rear"):
        m.spherical(f"lower arm {w} {end} pivot", chassis, arm, point=p[f"lower_pivot_{end}"])
    m.spherical(f"lower ball joint {w}", arm, upright, point=p["lower_ball_joint"])
    strut = np.subtract(p["strut_top"], p["lower_ball_joint"])
    m.point_on_line(f"strut {w}", (chassis, p["strut_top"]), (upright, p["lower_ball_joint"]), axis=strut)
    m.distance(f"toe link {w}", (upright, p["toe_link_outer"]), (chassis, p["toe_link_inner"]))
    ends = p["lower_ball_joint"], p["strut_top"]
    m.spring_damper(
        f"spring {w}", (upright, ends[0]), (chassis, ends[1]), stops=end_stops(side.axle, *ends), **REAR_SPRING
    )
    return upright
