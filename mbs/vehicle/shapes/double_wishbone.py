"""Shapes of a suspension by double wishbones."""

from mbs.vehicle.axle import Axle
from mbs.vehicle.shapes.appearance import Looks, between, fraction_along
from mbs.vehicle.shapes.knuckle import draw_knuckle
from mbs.vehicle.shapes.springs import draw_spring_and_damper
from mbs.vehicle.side import sides


def double_wishbone_shapes(looks: Looks, name: str, axle: Axle) -> None:
    """Draw both sides of a suspension."""
    for side in sides(name):
        w = side.wheel
        p = {key: side.point(point) for key, point in axle.suspension.points}
        lower, upper, upright = (looks.body(f"{part} {w}") for part in ("lower wishbone", "upper wishbone", "upright"))
        for part, arm, radius in (("lower", lower, 0.014), ("upper", upper, 0.012)):
            front, rear, ball = p[f"{part}_pivot_front"], p[f"{part}_pivot_rear"], p[f"{part}_ball_joint"]
            looks.tube((arm, front), (arm, ball), (arm, rear), radius=radius)
            for pivot in (front, rear):
                looks.ball((arm, pivot), 1.6 * radius)
            looks.ball((arm, ball), 1.7 * radius)
        front, rear, ball = p["lower_pivot_front"], p["lower_pivot_rear"], p["lower_ball_joint"]
        fraction = min(max(fraction_along(between(front, rear, 0.5), ball, p["spring_lower"]), 0.1), 0.9)
        legs = between(front, ball, fraction), between(rear, ball, fraction)
        looks.tube((lower, legs[0]), (lower, p["spring_lower"]), (lower, legs[1]), radius=0.012)
        joints = [(upright, p["lower_ball_joint"]), (upright, p["upper_ball_joint"])]
        draw_knuckle(looks, side, upright, joints, (upright, p["tie_rod_outer"]))
        looks.rod(f"tie rod {w}", name, (upright, p["tie_rod_outer"]), p["tie_rod_inner"])
        draw_spring_and_damper(looks, f"spring {w}", (lower, p["spring_lower"]), (looks.chassis, p["spring_upper"]))
