"""Shapes of an engine or motor, and of the shafts to the driven wheels."""

from mbs.vehicle.shapes.appearance import BARE_STEEL, CAST_STEEL, DARK_PLASTIC, Looks
from mbs.vehicle.side import sides

ENGINE_SIZE = 0.44, 0.46, 0.36  # m, of a small car
MOTOR_SIZE = 0.13, 0.34  # m, radius and length of a motor across the car
INNER_JOINT_OFFSET = 0.16  # m: of the inner joints of the shafts from the middle of the car


def powertrain_shapes(looks: Looks) -> None:
    """Draw an engine or motor between the driven wheels, and their shafts."""
    car, chassis = looks.car, looks.chassis
    name = car.drive.wheels
    axle = getattr(car, name)
    x, _, z = axle.wheel.centre
    inward = -1.0 if name == "front" else 1.0
    if car.drive.kind == "electric":
        radius, length = (looks.scale * size for size in MOTOR_SIZE)
        looks.cylinder(chassis, ((x, -0.5 * length, z), (x, 0.5 * length, z)), radius)
        looks.shape(
            chassis, "box", at=(x, 0.0, z + 1.4 * radius), size=(1.8 * radius, length, 0.7 * radius), **DARK_PLASTIC
        )
    else:
        size = tuple(looks.scale * edge for edge in ENGINE_SIZE)
        at = x + inward * (0.5 * size[0] + 0.10), 0.0, z + 0.25 * size[2]
        looks.shape(chassis, "box", at=at, size=size, **CAST_STEEL)
        looks.ball((chassis, (x, 0.0, z)), 0.11, **CAST_STEEL)
    for side in sides(name):
        inner = x, side.sign * INNER_JOINT_OFFSET, z
        carrier = looks.spins[side.wheel].carrier
        looks.tube((chassis, inner), (carrier, side.point(axle.wheel.centre)), radius=0.012, **BARE_STEEL)
