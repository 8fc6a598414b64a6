"""Shapes of suspensions by a lower arm and a strut that is fixed in the upright."""

from mbs.vehicle.axle import Axle
from mbs.vehicle.shapes.appearance import CAST_STEEL, Looks, between, fraction_along
from mbs.vehicle.shapes.knuckle import draw_knuckle
from mbs.vehicle.shapes.springs import draw_spring_and_damper
from mbs.vehicle.side import sides


def lower_arm_strut_shapes(looks: Looks, name: str, axle: Axle) -> None:
    """Draw both sides of a suspension whose strut stands on the ball joint and which a toe link steers."""
    _strut_shapes(looks, name, axle, "lower_ball_joint", "toe_link")


def macpherson_shapes(looks: Looks, name: str, axle: Axle) -> None:
    """Draw both sides of a MacPherson suspension."""
    _strut_shapes(looks, name, axle, "strut_lower", "tie_rod")


def _strut_shapes(looks: Looks, name: str, axle: Axle, foot: str, rod: str) -> None:
    """Draw both sides. `foot`: name of the lower point of the strut; `rod`: name of the rod that steers the upright."""
    for side in sides(name):
        w = side.wheel
        p = {key: side.point(point) for key, point in axle.suspension.points}
        arm, upright = looks.body(f"lower arm {w}"), looks.body(f"upright {w}")
        ball, bottom, top = p["lower_ball_joint"], p[foot], p["strut_top"]
        looks.tube((arm, p["lower_pivot_front"]), (arm, ball), (arm, p["lower_pivot_rear"]), radius=0.015)
        for pivot in ("lower_pivot_front", "lower_pivot_rear", "lower_ball_joint"):
            looks.ball((arm, p[pivot]), 0.023)
        # the tube of the strut stands in the upright above the wheel's height
        fraction = max(fraction_along(bottom, top, side.point(axle.wheel.centre)), 0.0)
        clamp = between(bottom, top, min(fraction + 0.05, 0.5))
        draw_knuckle(looks, side, upright, [(upright, ball), (upright, clamp)], (upright, p[f"{rod}_outer"]))
        looks.tube((upright, bottom), (upright, clamp), radius=0.024, **CAST_STEEL)
        looks.rod(f"{rod.replace('_', ' ')} {w}", name, (upright, p[f"{rod}_outer"]), p[f"{rod}_inner"])
        draw_spring_and_damper(looks, f"spring {w}", (upright, bottom), (looks.chassis, top))
