"""Shapes of a twist beam."""

from mbs.vehicle.axle import Axle
from mbs.vehicle.shapes.appearance import BARE_STEEL, Looks
from mbs.vehicle.shapes.knuckle import draw_knuckle
from mbs.vehicle.shapes.springs import draw_coil, draw_damper
from mbs.vehicle.side import sides


def twist_beam_shapes(looks: Looks, name: str, axle: Axle) -> None:
    """Draw the trailing arms and the cross-beam."""
    beam_ends = []
    for side in sides(name):
        w = side.wheel
        p = {key: side.point(point) for key, point in axle.suspension.points}
        half = looks.body(f"half axle {w}")
        centre = side.point(axle.wheel.centre)
        spindle = centre[0], p["damper_lower"][1], centre[2]
        looks.ball((half, p["pivot"]), 0.034)
        looks.tube((half, p["pivot"]), (half, p["cross_beam"]), (half, spindle), radius=0.026)
        looks.tube((half, p["cross_beam"]), (half, p["spring_lower"]), (half, spindle), radius=0.016)
        looks.tube((half, spindle), (half, p["damper_lower"]), radius=0.016)
        draw_knuckle(looks, side, half, [(half, spindle)], None)
        draw_coil(looks, f"spring {w}", (half, p["spring_lower"]), (looks.chassis, p["spring_upper"]))
        draw_damper(looks, (half, p["damper_lower"]), (looks.chassis, p["damper_upper"]))
        beam_ends.append((half, p["cross_beam"]))
    looks.tube(*beam_ends, radius=0.030, name=f"cross-beam {name}", **BARE_STEEL)
