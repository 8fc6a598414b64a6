"""All checks of a car, in order."""

from collections.abc import Iterator

from mbs.common.errors import ModelError
from mbs.vehicle.axle import Axle
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.checks.equilibrium import Rest
from mbs.vehicle.checks.masses import mass_faults
from mbs.vehicle.checks.places import place_faults, place_oddities
from mbs.vehicle.section import sections_of


def car_faults(car: CarContent) -> Iterator[str]:
    """Yield a sentence for each fault of a car, without its equilibrium."""
    for section in sections_of(car):
        yield from section.faults()
    yield from _dimension_faults(car)
    yield from place_faults(car)
    yield from mass_faults(car)
    for axle in (car.front, car.rear):
        yield from _radius_faults(axle)
    if car.chassis.frame is not None:
        try:
            car.chassis.frame.check(car.folder)
        except ModelError as error:
            yield str(error)


def car_oddities(car: CarContent, rest: Rest) -> list[str]:
    """Sentences on the unusual properties of a car. `rest`: the car at rest."""
    return [
        *(sentence for section in sections_of(car) for sentence in section.oddities()),
        *rest.oddities(car),
        *place_oddities(car),
        *_tyre_oddities(car, rest),
        *car.front.suspension.steering_oddities(car.steering, car.front.wheel.centre),
    ]


def _dimension_faults(car: CarContent) -> Iterator[str]:
    """Yield a sentence for each fault of wheelbase and tracks."""
    front, rear = car.front.wheel, car.rear.wheel
    radii = car.front.tyre.radius + car.rear.tyre.radius
    if car.wheelbase < radii:
        yield (
            f"{rear.key('centre')} lies {car.wheelbase:g} m behind {front.key('centre')}; "
            f"the wheels, of {radii:g} m together, pass each other."
        )
    if abs(front.centre[0]) > 1e-9:
        yield (
            f"{front.key('centre')} has x = {front.centre[0]:g} m; "
            "the origin is under the centre of the front axle, where x is 0."
        )
    for axle in (car.front, car.rear):
        if not axle.track > 0.0:
            yield (
                f"{axle.wheel.key('centre')} has y = {axle.wheel.centre[1]:g} m; "
                "the points are on the left side, where y is above 0."
            )


def _tyre_oddities(car: CarContent, rest: Rest) -> Iterator[str]:
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
