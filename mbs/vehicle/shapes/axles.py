"""Shapes of axles: suspensions by kind, wheel carriers, springs and dampers, anti-roll bars and wheels."""

from __future__ import annotations

import math
from collections.abc import Sequence

from mbs.model.body import Body
from mbs.vehicle.axes import LEFT
from mbs.vehicle.axle import Axle
from mbs.vehicle.shapes.appearance import (
    BARE_STEEL,
    CAST_STEEL,
    CHROME,
    SPRING_PAINT,
    Anchor,
    Looks,
    between,
    fraction_along,
    inboard,
)
from mbs.vehicle.side import Side, sides
from mbs.vehicle.suspensions.strut import StrutSuspension
from mbs.vehicle.tyres import Tyre

MODEL_NAMES = {"half": "half axle"}  # parts of a suspension whose bodies have another name in the model
RIM_CLEARANCE = 0.010  # m between rim and road when the tyre bottoms
# limits of what is drawn for unusual tyres, relative to the tyre radius
MIN_RIM_RATIO, MAX_WIDTH_RATIO = 0.5, 1.2
# width, m, at a nominal load, N, and its exponent: a tyre of 145 mm, of 185 mm at twice the load
REFERENCE_WIDTH, REFERENCE_LOAD, WIDTH_EXPONENT = 0.145, 1500.0, 0.35
HUB_SIZE = 0.055, 0.030  # m: length and radius of the hub of a small car
BEARING_LENGTH = 0.02  # m: length of the hub that is drawn beside the wheel centre
ARM_RADIUS, STEERING_ARM_RADIUS = 0.020, 0.013  # m
COIL_RADIUS, WIRE_DIAMETER, DAMPER_RADIUS = 0.046, 0.011, 0.020  # m, of a small car
COIL_PITCH = 0.038  # m from coil to coil
MAX_SPRING_LENGTH = 0.42  # m: a longer distance is drawn with a spring seat on the tube of the damper


def strut_shapes(looks: Looks, name: str, axle: Axle) -> None:
    """Draw both sides of a suspension by a lower arm, a strut and a rod that steers the upright."""
    suspension = axle.suspension
    assert isinstance(suspension, StrutSuspension), "by its kind"
    for side in sides(name):
        w = side.wheel
        p = {key: side.point(point) for key, point in suspension.points}
        arm, upright = looks.body(f"lower arm {w}"), looks.body(f"upright {w}")
        ball, bottom, top = p["lower_ball_joint"], p[suspension.foot], p["strut_top"]
        looks.tube((arm, p["lower_pivot_front"]), (arm, ball), (arm, p["lower_pivot_rear"]), radius=0.015)
        for pivot in ("lower_pivot_front", "lower_pivot_rear", "lower_ball_joint"):
            looks.ball((arm, p[pivot]), 0.023)
        # the tube of the strut stands in the upright above the wheel's height
        fraction = max(fraction_along(bottom, top, side.point(axle.wheel.centre)), 0.0)
        clamp = between(bottom, top, min(fraction + 0.05, 0.5))
        inner, outer = side.point(suspension.rod_point("inner")), side.point(suspension.rod_point("outer"))
        draw_knuckle(looks, side, upright, [(upright, ball), (upright, clamp)], (upright, outer))
        looks.tube((upright, bottom), (upright, clamp), radius=0.024, **CAST_STEEL)
        looks.rod(f"{suspension.rod} {w}", name, (upright, outer), inner)
        draw_spring_and_damper(looks, f"spring {w}", (upright, bottom), (looks.chassis, top))


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


def anti_roll_bar_shapes(looks: Looks, name: str, axle: Axle) -> None:
    """Draw the anti-roll bar of an axle, if it has one."""
    bar = axle.anti_roll_bar
    if bar is None:
        return
    pivots = []
    for side in sides(name):
        w = side.wheel
        pivot, lever_end, link_end = (
            side.point(point) for point in (bar.points.pivot, bar.points.lever_end, bar.points.link_end)
        )
        link_body = looks.body(f"{MODEL_NAMES.get(bar.part, bar.part.replace('_', ' '))} {w}")
        lever = looks.m.turning(
            f"anti-roll lever {w}", looks.chassis, at=pivot, axis=LEFT, angle=f"anti_roll_bar_{w}.angle"
        )
        looks.tube((lever, pivot), (lever, lever_end), radius=0.010, **BARE_STEEL)
        looks.tube((lever, lever_end), (link_body, link_end), radius=0.006, name=f"anti-roll link {w}", **CAST_STEEL)
        for owner, position in ((lever, lever_end), (link_body, link_end), (looks.chassis, pivot)):
            looks.ball((owner, position), 0.013)
        pivots.append((looks.chassis, pivot))
    looks.tube(*pivots, radius=0.010, name=f"anti-roll bar {name}", **BARE_STEEL)


def rim_radius(tyre: Tyre) -> float:
    """Radius of the rim, m, estimated from the radius at which the tyre bottoms."""
    return max(tyre.bottoming_radius - RIM_CLEARANCE, MIN_RIM_RATIO * tyre.radius)


def tyre_width(tyre: Tyre) -> float:
    """Width, m, estimated from the nominal load; for pictures only."""
    width = REFERENCE_WIDTH * (tyre.nominal_load / REFERENCE_LOAD) ** WIDTH_EXPONENT
    return float(min(width, MAX_WIDTH_RATIO * tyre.radius))


def wheel_shapes(looks: Looks, name: str, axle: Axle) -> None:
    """Draw the wheels of an axle."""
    sizes = {"radius": axle.tyre.radius, "width": tyre_width(axle.tyre), "rim": rim_radius(axle.tyre)}
    for side in sides(name):
        looks.shape(looks.spins[side.wheel], "wheel", **sizes, name=f"wheel {side.wheel}")


def draw_knuckle(looks: Looks, side: Side, carrier: Body, joints: Sequence[Anchor], arm: Anchor | None) -> None:
    """Draw hub and arms on the carrier; the shape of the wheel includes the brake disc.

    `joints`: joints of the carrier, from the lowest to the highest; `arm`: outer end of the rod that steers it.
    """
    axle = getattr(looks.car, side.axle)
    centre = side.point(axle.wheel.centre)
    length, radius = (looks.scale * size for size in HUB_SIZE)
    hub = inboard(centre, length)
    below = [joint for joint in joints if joint[1][2] <= hub[2]]
    above = [joint for joint in joints if joint[1][2] > hub[2]]
    # one tube from the lowest joint through the hub to the highest one
    looks.tube(*below, (carrier, hub), *above, radius=ARM_RADIUS, **CAST_STEEL)
    looks.cylinder(carrier, (inboard(hub, BEARING_LENGTH), centre), radius)
    if arm is not None:
        looks.tube((carrier, hub), arm, radius=STEERING_ARM_RADIUS, **CAST_STEEL)


def draw_spring_and_damper(looks: Looks, name: str, lower: Anchor, upper: Anchor) -> None:
    """Draw a coil spring around its damper. `lower`, `upper`: its ends."""
    draw_damper(looks, lower, upper)
    length = math.dist(lower[1], upper[1])
    draw_coil(looks, name, lower, upper, seat=max(length - MAX_SPRING_LENGTH, 0.0))


def draw_coil(looks: Looks, name: str, lower: Anchor, upper: Anchor, seat: float = 0.0) -> None:
    """Draw a coil spring whose coil begins at a distance `seat`, m, from its lower end."""
    scale = looks.scale
    coils = max(3, round((math.dist(lower[1], upper[1]) - seat) / (scale * COIL_PITCH)))
    looks.shape(
        lower[0],
        "spring",
        ends=(lower, upper),
        radius=scale * COIL_RADIUS,
        wire=scale * WIRE_DIAMETER,
        coils=coils,
        seat=seat or None,
        name=name,
        **SPRING_PAINT,
    )


def draw_damper(looks: Looks, lower: Anchor, upper: Anchor) -> None:
    """Draw a telescopic damper."""
    looks.shape(lower[0], "damper", ends=(lower, upper), radius=looks.scale * DAMPER_RADIUS, **CHROME)
