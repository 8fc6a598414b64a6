"""Looks of the driver, of persons and of luggage: simple shapes at the places of the payloads."""

import math

from mbs.vehicle.car_content import CarContent
from mbs.vehicle.shapes.appearance import CLOTH, SILL, Looks, Paint
from mbs.vehicle.side import Point

SKIN: Paint = {"material": "plastic", "color": "#c99b7d"}
SHIRT: Paint = {"material": "plastic", "color": "#35618f"}
HELMET: Paint = {"material": "paint", "color": "#e8e6df"}
TROUSERS: Paint = {"material": "plastic", "color": "#2f3440"}
RECLINE = math.radians(15.0)  # of the backs of the seats
CASE: Paint = {"material": "plastic", "color": "#6b4f34"}
COS, SIN = math.cos(RECLINE), math.sin(RECLINE)
TILT = math.radians(24.0)  # of the steering column from the level
AHEAD = 0.42, 0.26  # m: middle of the steering wheel before and above the driver's centre of mass
RADIUS = 0.185  # m, of the steering wheel
UP, ASIDE = RADIUS * math.sin(math.radians(20.0)), RADIUS * math.cos(math.radians(20.0))  # hands, on its rim
PERSON = 30.0  # kg: a payload of so much and more is drawn as a person


def driver_place(car: CarContent) -> Point:
    """Centre of mass of the driver: that of the payload of this name, or opposite to the passenger."""
    if "driver" in car.payload:
        return car.payload["driver"].point
    if "passenger" in car.payload:
        x, y, z = car.payload["passenger"].point
        return x, -y, z
    x = car.front.wheel.centre[0] - 0.55 * car.wheelbase
    return x, 0.2 * car.vehicle.width, car.vehicle.reference_point[2] + 0.1


def steering_wheel_place(car: CarContent) -> Point:
    """Middle of the steering wheel: before the driver."""
    x, y, z = driver_place(car)
    return x + AHEAD[0], y, z + AHEAD[1]


def occupant_shapes(looks: Looks) -> None:
    """Draw the driver, and the payloads that the car's file gives a mass."""
    car = looks.car
    _person(looks, driver_place(car), driver=True)
    for name, payload in car.payload.items():
        if name == "driver" or payload.mass <= 0.0:
            continue
        if "luggage" in name or payload.mass < PERSON:
            size = 0.25 + 0.004 * payload.mass
            looks.shape(looks.chassis, "box", at=payload.point, size=(0.8 * size, 1.6 * size, size), **CASE)
        else:
            _person(looks, payload.point, driver=False)


def _person(looks: Looks, at: Point, driver: bool) -> None:
    """A person who sits, with the seat; `at` is the centre of mass."""
    chassis, (x, y, z), floor = looks.chassis, at, SILL * looks.car.front.tyre.radius

    def limb(radius: float, paint: Paint, *offsets: tuple[float, float, float]) -> None:
        points = [(chassis, (x + a, y + b, max(z + c, floor + radius))) for a, b, c in offsets]
        looks.shape(chassis, "tube", points=points, radius=radius, **paint)

    limb(0.135, SHIRT, (-0.04, 0.0, -0.08), (-0.14, 0.0, 0.30))
    looks.shape(chassis, "sphere", at=(x - 0.17, y, z + 0.53), radius=0.115, **(HELMET if driver else SKIN))
    for side in (1.0, -1.0):
        limb(0.072, TROUSERS, (-0.02, 0.09 * side, -0.14), (0.38, 0.12 * side, -0.02), (0.66, 0.11 * side, -0.32))
        at_rim = (AHEAD[0] + UP * math.sin(TILT), ASIDE * side, AHEAD[1] + UP * math.cos(TILT))
        hands = at_rim if driver else (0.24, 0.16 * side, 0.0)
        limb(0.045, SHIRT, (-0.13, 0.19 * side, 0.26), (0.08, 0.23 * side, 0.04), hands)
        looks.shape(chassis, "sphere", at=(x + hands[0], y + hands[1], z + hands[2]), radius=0.05, **SKIN)
    looks.shape(chassis, "box", at=(x + 0.10, y, max(z - 0.26, floor + 0.06)), size=(0.50, 0.44, 0.12), **CLOTH)
    tilt = ((COS, 0.0, -SIN), (0.0, 1.0, 0.0), (SIN, 0.0, COS))
    looks.shape(chassis, "box", at=(x - 0.28, y, z + 0.10), size=(0.10, 0.46, 0.72), axes=tilt, **CLOTH)
