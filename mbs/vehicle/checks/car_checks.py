"""All checks of a car, in order."""

from collections.abc import Iterator

from mbs.common.errors import ModelError
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.checks.dimensions import dimension_faults
from mbs.vehicle.checks.equilibrium import Rest
from mbs.vehicle.checks.masses import mass_faults
from mbs.vehicle.checks.places import place_faults, place_oddities
from mbs.vehicle.checks.tyres import tyre_faults, tyre_oddities
from mbs.vehicle.section import sections_of


def car_faults(car: CarContent) -> list[str]:
    """Sentences on the faults of a car; `settled` tests the equilibrium."""
    return list(_faults(car))


def _faults(car: CarContent) -> Iterator[str]:
    """Yield a sentence for each fault."""
    for section in sections_of(car):
        yield from section.faults()
    yield from dimension_faults(car)
    yield from place_faults(car)
    yield from mass_faults(car)
    yield from tyre_faults(car)
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
        *tyre_oddities(car, rest),
        *car.front.suspension.steering_oddities(car.steering, car.front.wheel.centre),
    ]
