"""Checks of wheelbase and tracks."""

from collections.abc import Iterator

from mbs.vehicle.car_content import CarContent


def dimension_faults(car: CarContent) -> Iterator[str]:
    """Yield a sentence for each fault."""
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
