"""Shapes of a whole car; a module of this package draws each part."""

from collections.abc import Callable, Mapping

from mbs.model.carried_parts import Spin
from mbs.model.flexible import FlexibleBody
from mbs.model.table_bodies import TabledBody
from mbs.system.drawing import POSE
from mbs.vehicle.axle import Axle
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.chassis.frames.tubes import TubesFrame
from mbs.vehicle.shapes.appearance import Looks
from mbs.vehicle.shapes.axles import (
    anti_roll_bar_shapes,
    double_wishbone_shapes,
    strut_shapes,
    twist_beam_shapes,
    wheel_shapes,
)
from mbs.vehicle.shapes.body_shell import body_shell_shapes
from mbs.vehicle.shapes.occupants import occupant_shapes
from mbs.vehicle.shapes.powertrain import powertrain_shapes
from mbs.vehicle.shapes.steering import steering_shapes, tie_rod_owner
from mbs.vehicle.shapes.tube_frame import tube_frame_shapes

SUSPENSIONS: Mapping[str, Callable[[Looks, str, Axle], None]] = {
    "double_wishbone": double_wishbone_shapes,
    "lower_arm_strut": strut_shapes,
    "macpherson": strut_shapes,
    "twist_beam": twist_beam_shapes,
}
"""Functions that draw suspensions, by kind of suspension."""


def car_shapes(b: CarBuilder, car: CarContent, spins: Mapping[str, Spin], links: bool) -> None:
    """Draw a car whose model has all its bodies and sensors.

    `spins`: its wheels by name; `links`: whether its suspensions are linkages, not tables.
    """
    b.m.default_shapes = False
    linked = links and car.linked
    for wheel, spin in spins.items():
        if isinstance(spin.carrier, TabledBody):
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
