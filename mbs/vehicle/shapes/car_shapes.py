"""Shapes of a whole car, of its powertrain and of a frame of tubes; other modules here draw the other parts."""

from collections.abc import Callable, Mapping

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from mbs.model.carried_parts import Spin
from mbs.model.flexible import FlexibleBody
from mbs.model.table_bodies import LookupTableBody
from mbs.system.drawing import POSE
from mbs.vehicle.axle import Axle
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.chassis.frames.tubes import TubesFrame, TubularFrame
from mbs.vehicle.shapes.appearance import BARE_STEEL, CAST_STEEL, DARK_PLASTIC, FRAME_PAINT, Looks
from mbs.vehicle.shapes.axles import (
    anti_roll_bar_shapes,
    double_wishbone_shapes,
    strut_shapes,
    twist_beam_shapes,
    wheel_shapes,
)
from mbs.vehicle.shapes.body_shell import body_shell_shapes
from mbs.vehicle.shapes.occupants import occupant_shapes
from mbs.vehicle.shapes.steering import steering_shapes, tie_rod_owner
from mbs.vehicle.side import sides

SUSPENSIONS: Mapping[str, Callable[[Looks, str, Axle], None]] = {
    "double_wishbone": double_wishbone_shapes,
    "lower_arm_strut": strut_shapes,
    "macpherson": strut_shapes,
    "twist_beam": twist_beam_shapes,
}
"""Functions that draw suspensions, by kind of suspension."""
ENGINE_SIZE = 0.44, 0.46, 0.36  # m, of a small car
MOTOR_SIZE = 0.13, 0.34  # m, radius and length of a motor across the car
CASE_SIZE = 1.8, 0.7  # width and height of the inverter on a motor, relative to the radius of the motor
CASE_HEIGHT = 1.4  # its middle above the axis of the motor, relative to this radius
ENGINE_OFFSET = 0.10  # m between the axis of the wheels and the near face of an engine
ENGINE_RAISE = 0.25  # middle of an engine above this axis, relative to its height
DIFFERENTIAL_RADIUS, SHAFT_RADIUS, FLOOR_THICKNESS = 0.11, 0.012, 0.004  # m
INNER_JOINT_OFFSET = 0.16  # m: of the inner joints of the shafts from the middle of the car
FRAME_TUBE = "frame tube"
"""Name of the shapes of the tubes, which closed bodies hide; absent if the frame is a flexible body."""
FLOOR_RANGE = 0.05  # m above the lowest joint: joints in this range carry the floor


def car_shapes(b: CarBuilder, car: CarContent, spins: Mapping[str, Spin], links: bool) -> None:
    """Draw a car whose model has all its bodies and sensors.

    `spins`: its wheels by name; `links`: whether its suspensions are linkages, not tables.
    """
    b.m.default_shapes = False
    linked = links and car.linked
    for wheel, spin in spins.items():
        if isinstance(spin.carrier, LookupTableBody):
            spin.carrier.outputs = tuple(f"wheel_{wheel}.{part}" for part in (*POSE, "angle"))
    looks = Looks(b, car, spins, tie_rod_owner(b, car) if linked else b.chassis.frame)
    for name, axle in car.axles.items():
        if linked:
            SUSPENSIONS[axle.suspension.kind](looks, name, axle)
            anti_roll_bar_shapes(looks, name, axle)
        wheel_shapes(looks, name, axle)
    if linked:
        steering_shapes(looks)
        powertrain_shapes(looks)
    occupant_shapes(looks)
    frame = car.chassis.frame
    if tubes := isinstance(frame, TubesFrame):
        tube_frame_shapes(looks, frame.tubular(car.folder), bends=isinstance(b.chassis.body, FlexibleBody))
    if car.chassis.body in ("clear", "closed") or (car.chassis.body == "auto" and not tubes):
        body_shell_shapes(looks, clear=car.chassis.body == "clear")


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
            chassis,
            "box",
            at=(x, 0.0, z + CASE_HEIGHT * radius),
            size=(CASE_SIZE[0] * radius, length, CASE_SIZE[1] * radius),
            **DARK_PLASTIC,
        )
    else:
        size = tuple(looks.scale * edge for edge in ENGINE_SIZE)
        at = x + inward * (0.5 * size[0] + ENGINE_OFFSET), 0.0, z + ENGINE_RAISE * size[2]
        looks.shape(chassis, "box", at=at, size=size, **CAST_STEEL)
        looks.ball((chassis, (x, 0.0, z)), DIFFERENTIAL_RADIUS, **CAST_STEEL)
    for side in sides(name):
        inner = x, side.sign * INNER_JOINT_OFFSET, z
        carrier = looks.spins[side.wheel].carrier
        looks.tube((chassis, inner), (carrier, side.point(axle.wheel.centre)), radius=SHAFT_RADIUS, **BARE_STEEL)


def tube_frame_shapes(looks: Looks, frame: TubularFrame, *, bends: bool) -> None:
    """Draw the tubes, unless they are drawn as beams, and the floor.

    `frame`: frame of the tables of the car; `bends`: whether the chassis is a flexible body, whose beams are
    drawn.
    """
    joints = frame.joint_places()
    paint = FRAME_PAINT if looks.car.chassis.body in ("auto", "open") else CAST_STEEL
    if not bends:
        for tube in frame.frame(carried_masses=False)[1]:
            points = [(looks.chassis, joints[name]) for name in (tube.start, tube.end)]
            radius = 0.5 * frame.section.sections[tube.section].diameter
            looks.shape(looks.chassis, "tube", points=points, radius=radius, name=FRAME_TUBE, **paint)
    positions = np.array(list(joints.values()))
    low = positions[positions[:, 2] < positions[:, 2].min() + FLOOR_RANGE]
    try:
        corners = low[ConvexHull(low[:, :2]).vertices]
    except (QhullError, ValueError):  # no area
        return
    looks.shape(
        looks.chassis, "plate", points=[(looks.chassis, p) for p in corners], thickness=FLOOR_THICKNESS, **BARE_STEEL
    )
