"""Front suspension: double wishbones, coil-over on the lower one, tie rod to the rack."""

from __future__ import annotations

from mbs.model import Model
from mbs.model.body import Body
from mbs.model.guides import Guide
from mbs.scenes.prototype_car.car_data import FRONT, FRONT_BODIES, FRONT_SPRING
from mbs.scenes.prototype_car.side import Side
from mbs.scenes.prototype_car.stops import end_stops, steering_stop


def front_suspension(m: Model, chassis: Body, side: Side, rack: Guide) -> Body:
    """Add one side and return its upright, the carrier of the wheel."""
    w = side.wheel
    p = {name: side.point(point) for name, point in FRONT.items()}
    lower = side.body(m, "lower wishbone", FRONT_BODIES["lower_wishbone"])
    upper = side.body(m, "upper wishbone", FRONT_BODIES["upper_wishbone"])
    upright = side.body(m, "upright", FRONT_BODIES["upright"])
    for part, wishbone in (("lower", lower), ("upper", upper)):
        for end in ("front", "rear"):
            m.spherical(f"{part} wishbone {w} {end} pivot", chassis, wishbone, point=p[f"{part}_pivot_{end}"])
        m.spherical(f"{part} ball joint {w}", wishbone, upright, point=p[f"{part}_ball_joint"])
    rack_end = m.slide(f"rack end {w}", chassis, point=p["tie_rod_inner"], direction=(0.0, 1.0, 0.0), guide=rack)
    m.distance(f"tie rod {w}", (upright, p["tie_rod_outer"]), rack_end)
    ends = p["spring_lower"], p["spring_upper"]
    m.spring_damper(
        f"spring {w}", (lower, ends[0]), (chassis, ends[1]), stops=end_stops(side.axle, *ends), **FRONT_SPRING
    )
    m.spring_damper(
        f"steering stop {w}",
        (upright, p["tie_rod_outer"]),
        (lower, p["lower_pivot_front"]),
        stiffness=0.0,
        stops=steering_stop(),
    )
    return upright
