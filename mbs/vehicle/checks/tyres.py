"""Checks of tyres: their radius in the drawing and their load at rest."""

from collections.abc import Iterator

from mbs.vehicle.axle import Axle
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.checks.equilibrium import Rest


def tyre_faults(car: CarContent) -> Iterator[str]:
    """Yield a sentence for each fault."""
    for axle in (car.front, car.rear):
        yield from _radius_faults(axle)


def tyre_oddities(car: CarContent, rest: Rest) -> Iterator[str]:
    """Yield a sentence for each overloaded tyre. `rest`: the car at rest."""
    for name, axle in car.axles.items():
        tyre = axle.tyre
        load = rest.load[name]
        largest, key = tyre.largest_load
        if load > largest:
            yield (
                f"{key}: the forces grow with the load up to {largest:g} N, but at rest the {name} wheel carries "
                f"{load:.0f} N."
            )


def _radius_faults(axle: Axle) -> Iterator[str]:
    """Yield a fault of a radius against the height of the wheel centre."""
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
