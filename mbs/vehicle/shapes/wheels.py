"""Looks of the wheels: tyre and rim from the data of the tyre."""

from mbs.vehicle.axle import Axle
from mbs.vehicle.shapes.appearance import Looks
from mbs.vehicle.side import sides
from mbs.vehicle.tyres import Tyre

ABOVE_RIM = 0.010  # m: a tyre that bottoms has so much between rim and road
WIDTH, LOAD, GROWTH = 0.145, 1500.0, 0.35  # m at a nominal load, N: a 145 tyre; 185 at twice of it


def rim_radius(tyre: Tyre) -> float:
    """Radius of the rim, m: a tyre that bottoms stands on it."""
    return max(tyre.bottoming_radius - ABOVE_RIM, 0.5 * tyre.radius)


def tyre_width(tyre: Tyre) -> float:
    """Width by the nominal load, as usual sizes have it, m: for pictures only."""
    return float(min(WIDTH * (tyre.nominal_load / LOAD) ** GROWTH, 1.2 * tyre.radius))


def wheel_shapes(looks: Looks, name: str, axle: Axle) -> None:
    """Draw the wheels of an axle."""
    sizes = {"radius": axle.tyre.radius, "width": tyre_width(axle.tyre), "rim": rim_radius(axle.tyre)}
    for side in sides(name):
        looks.shape(looks.spins[side.wheel], "wheel", **sizes, name=f"wheel {side.wheel}")
