"""Tyres: their radius against the drawing, their curves, their load."""

from collections.abc import Iterator

from mbs.vehicle.axle import Axle
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.checks.equilibrium import Rest


def tyre_faults(car: CarContent) -> Iterator[str]:
    """A sentence for each fault."""
    for axle in (car.front, car.rear):
        yield from _radii(axle)


def tyre_oddities(car: CarContent, rest: Rest) -> Iterator[str]:
    """A sentence for each thing that is odd."""
    for wheels, axle in car.axles.items():
        tyre = axle.tyre
        load = rest.load[wheels]
        largest, key = tyre.largest_load
        if load > largest:
            yield (
                f"{key}: the forces grow with the load up to {largest:g} N, but at rest the {wheels} wheel carries "
                f"{load:.0f} N."
            )


def _radii(axle: Axle) -> Iterator[str]:
    radius, height = axle.tyre.radius, axle.wheel.centre[2]
    if height > radius:
        yield (
            f"{axle.tyre.key('radius')} is {radius:g} m, but {axle.wheel.key('centre')} is {height:g} m above the "
            "ground: a car in equilibrium stands on its tyres, and the height is less."
        )
    elif not axle.tyre.bottoming_radius < height:
        yield (
            f"{axle.tyre.key('bottoming_radius')} is {axle.tyre.bottoming_radius:g} m; it must be less than the height "
            f"of the wheel's centre, {height:g} m."
        )
