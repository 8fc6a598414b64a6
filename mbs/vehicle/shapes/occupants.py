"""Shapes of the driver, of passengers and of luggage at the positions of the payloads."""

import math

from mbs.vehicle.car_content import CarContent
from mbs.vehicle.shapes.appearance import SEAT_PAINT, SILL_HEIGHT, Looks, Paint
from mbs.vehicle.side import Point

SKIN_PAINT: Paint = {"material": "plastic", "color": "#c99b7d"}
SHIRT_PAINT: Paint = {"material": "plastic", "color": "#35618f"}
HELMET_PAINT: Paint = {"material": "paint", "color": "#e8e6df"}
TROUSER_PAINT: Paint = {"material": "plastic", "color": "#2f3440"}
LUGGAGE_PAINT: Paint = {"material": "plastic", "color": "#6b4f34"}
BACKREST_ANGLE = math.radians(15.0)  # of the backs of the seats, from the vertical
BACKREST_COS, BACKREST_SIN = math.cos(BACKREST_ANGLE), math.sin(BACKREST_ANGLE)
COLUMN_TILT = math.radians(24.0)  # of the steering column from the horizontal
STEERING_WHEEL_OFFSET = 0.42, 0.26  # m: of its middle, ahead of and above the driver's centre of mass
STEERING_WHEEL_RADIUS = 0.185  # m
# hands on the rim of the steering wheel, m: up along it, and to the side
HAND_HEIGHT, HAND_OFFSET = (
    STEERING_WHEEL_RADIUS * math.sin(math.radians(20.0)),
    STEERING_WHEEL_RADIUS * math.cos(math.radians(20.0)),
)
MIN_PERSON_MASS = 30.0  # kg: a lighter payload is drawn as luggage


def driver_place(car: CarContent) -> Point:
    """Centre of mass of the driver: of its payload, otherwise opposite to the passenger, otherwise estimated."""
    if "driver" in car.payload:
        return car.payload["driver"].point
    if "passenger" in car.payload:
        x, y, z = car.payload["passenger"].point
        return x, -y, z
    x = car.front.wheel.centre[0] - 0.55 * car.wheelbase
    return x, 0.2 * car.vehicle.width, car.vehicle.reference_point[2] + 0.1


def steering_wheel_place(car: CarContent) -> Point:
    """Middle of the steering wheel, ahead of the driver."""
    x, y, z = driver_place(car)
    return x + STEERING_WHEEL_OFFSET[0], y, z + STEERING_WHEEL_OFFSET[1]


def occupant_shapes(looks: Looks) -> None:
    """Draw the driver, and the payloads with a mass in the car file."""
    car = looks.car
    _draw_person(looks, driver_place(car), driver=True)
    for name, payload in car.payload.items():
        if name == "driver" or payload.mass <= 0.0:
            continue
        if "luggage" in name or payload.mass < MIN_PERSON_MASS:
            size = 0.25 + 0.004 * payload.mass
            looks.shape(looks.chassis, "box", at=payload.point, size=(0.8 * size, 1.6 * size, size), **LUGGAGE_PAINT)
        else:
            _draw_person(looks, payload.point, driver=False)


def _draw_person(looks: Looks, centre_of_mass: Point, driver: bool) -> None:
    """Draw a sitting person with the seat. `centre_of_mass`: centre of mass of the person, m."""
    chassis, (x, y, z), floor = looks.chassis, centre_of_mass, SILL_HEIGHT * looks.car.front.tyre.radius

    def draw_limb(radius: float, paint: Paint, *offsets: tuple[float, float, float]) -> None:
        """Draw a tube through points at offsets from the centre of mass, above the floor."""
        points = [(chassis, (x + a, y + b, max(z + c, floor + radius))) for a, b, c in offsets]
        looks.shape(chassis, "tube", points=points, radius=radius, **paint)

    draw_limb(0.135, SHIRT_PAINT, (-0.04, 0.0, -0.08), (-0.14, 0.0, 0.30))
    looks.shape(chassis, "sphere", at=(x - 0.17, y, z + 0.53), radius=0.115, **(HELMET_PAINT if driver else SKIN_PAINT))
    for side in (1.0, -1.0):
        draw_limb(
            0.072, TROUSER_PAINT, (-0.02, 0.09 * side, -0.14), (0.38, 0.12 * side, -0.02), (0.66, 0.11 * side, -0.32)
        )
        at_rim = (
            STEERING_WHEEL_OFFSET[0] + HAND_HEIGHT * math.sin(COLUMN_TILT),
            HAND_OFFSET * side,
            STEERING_WHEEL_OFFSET[1] + HAND_HEIGHT * math.cos(COLUMN_TILT),
        )
        hands = at_rim if driver else (0.24, 0.16 * side, 0.0)
        draw_limb(0.045, SHIRT_PAINT, (-0.13, 0.19 * side, 0.26), (0.08, 0.23 * side, 0.04), hands)
        looks.shape(chassis, "sphere", at=(x + hands[0], y + hands[1], z + hands[2]), radius=0.05, **SKIN_PAINT)
    looks.shape(chassis, "box", at=(x + 0.10, y, max(z - 0.26, floor + 0.06)), size=(0.50, 0.44, 0.12), **SEAT_PAINT)
    tilt = ((BACKREST_COS, 0.0, -BACKREST_SIN), (0.0, 1.0, 0.0), (BACKREST_SIN, 0.0, BACKREST_COS))
    looks.shape(chassis, "box", at=(x - 0.28, y, z + 0.10), size=(0.10, 0.46, 0.72), axes=tilt, **SEAT_PAINT)
