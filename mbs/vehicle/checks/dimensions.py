"""Wheelbase, tracks and outline."""

from __future__ import annotations

from collections.abc import Iterator

from mbs.vehicle.car_content import CarContent

LEAST_WHEELBASE, LEAST_TRACK = 1.0, 0.6  # m
OVERHANG, BESIDE = 3.0, 0.9  # m: most that the outline has beyond both axles, and beyond both wheels' centres


def dimension_faults(car: CarContent) -> Iterator[str]:
    """A sentence for each fault."""
    front, rear = car.front.wheel, car.rear.wheel
    wheels = car.front.tyre.radius + car.rear.tyre.radius
    if car.wheelbase < max(LEAST_WHEELBASE, wheels):
        yield (
            f"{rear.key('centre')} lies {car.wheelbase:g} m behind {front.key('centre')}; a car has a wheelbase of "
            f"{LEAST_WHEELBASE:g} m or more, and its wheels, here of {wheels:g} m together, pass each other."
        )
    if abs(front.centre[0]) > 1e-9:
        yield (
            f"{front.key('centre')} has x = {front.centre[0]:g} m; "
            "the origin is under the centre of the front axle, where x is 0."
        )
    for axle in (car.front, car.rear):
        if axle.track < LEAST_TRACK:
            yield (
                f"{axle.wheel.key('centre')} has y = {axle.wheel.centre[1]:g} m; "
                f"the points are those of the left side, and a wheel is {0.5 * LEAST_TRACK:g} m or more to the left."
            )
    body = car.vehicle
    least = car.wheelbase + wheels
    if not least <= body.length <= car.wheelbase + OVERHANG:
        yield (
            f"{body.key('length')} is {body.length:g} m; with the wheelbase of {car.wheelbase:g} m and the wheels as "
            f"drawn it must be between {least:g} and {car.wheelbase + OVERHANG:g} m."
        )
    track = max(car.front.track, car.rear.track)
    if not track < body.width <= track + BESIDE:
        yield (
            f"{body.key('width')} is {body.width:g} m; the centres of the wheels are {track:g} m apart, so that it "
            f"must be between that and {track + BESIDE:g} m."
        )
