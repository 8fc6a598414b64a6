"""Tyres: their radius against the drawing, their curves, their load."""

from __future__ import annotations

from collections.abc import Iterator

from mbs.vehicle.axle import Axle
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.checks.equilibrium import Rest

LARGEST_DEFLECTION = 0.25  # of the free radius of a tyre at rest
MOST_GRIP = 3.0  # force over the load
GRIPPED = 0.02  # force over the load that a tyre must reach on the road: half of what wet ice gives


def tyre_faults(car: CarContent) -> Iterator[str]:
    """A sentence for each fault."""
    for axle in (car.front, car.rear):
        yield from _radii(axle)


def tyre_oddities(car: CarContent, rest: Rest) -> Iterator[str]:
    """A sentence for each thing that is odd."""
    for wheels, axle in car.axles.items():
        road, tyre = car.road, axle.tyre
        least, most = (share(tyre.friction) * road.grip_of(tyre) for share in (min, max))
        if not GRIPPED <= least <= most <= MOST_GRIP:
            reached, told = (
                (least, f"with less than {GRIPPED:g} a car neither steers nor brakes")
                if least < GRIPPED
                else (most, f"no tyre reaches more than {MOST_GRIP:g}")
            )
            yield (
                f"{tyre.key('grip')} is {tyre.grip:g}, {road.key('friction')} {road.friction:g}, "
                f"{road.key('friction_factor')} {road.friction_factor:g} and {tyre.key('reference_friction')} "
                f"{tyre.reference_friction:g}: the {wheels} tyres reach {reached:.3g} of their load; {told}."
            )
        load = rest.load[wheels]
        largest, key = tyre.largest_load
        if load > largest:
            yield (
                f"{key}: the forces grow with the load up to {largest:g} N, but at rest the {wheels} wheel carries "
                f"{load:.0f} N."
            )


def _radii(axle: Axle) -> Iterator[str]:
    radius, height = axle.tyre.radius, axle.wheel.centre[2]
    if not (1.0 - LARGEST_DEFLECTION) * radius < height <= radius:
        yield (
            f"{axle.tyre.key('radius')} is {radius:g} m, but {axle.wheel.key('centre')} is {height:g} m above the "
            f"ground: a car in equilibrium stands on its tyres, {radius:g} m high or less by at most "
            f"{LARGEST_DEFLECTION:.0%}."
        )
        return
    if not 0.4 * radius <= axle.tyre.bottoming_radius < height:
        yield (
            f"{axle.tyre.key('bottoming_radius')} is {axle.tyre.bottoming_radius:g} m; it must be between "
            f"{0.4 * radius:.3g} m and the height of the wheel's centre, {height:g} m."
        )
