"""Shapes of the wheels: tyre and rim with the dimensions of the tyre."""

from mbs.vehicle.axle import Axle
from mbs.vehicle.shapes.appearance import Looks
from mbs.vehicle.side import sides
from mbs.vehicle.tyres import Tyre

RIM_CLEARANCE = 0.010  # m between rim and road when the tyre bottoms
# limits of what is drawn for unusual tyres, relative to the tyre radius
MIN_RIM_RATIO, MAX_WIDTH_RATIO = 0.5, 1.2
# width, m, at a nominal load, N, and its exponent: a tyre of 145 mm, of 185 mm at twice the load
REFERENCE_WIDTH, REFERENCE_LOAD, WIDTH_EXPONENT = 0.145, 1500.0, 0.35


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
