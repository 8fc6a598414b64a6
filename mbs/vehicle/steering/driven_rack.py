"""A rack or arm by angle that is asked for by a port, has a table or friction, or moves suspensions without links."""

from numpy.typing import ArrayLike

from mbs.elements.coordinate_friction import CoordinateFriction
from mbs.model.coordinate import Coordinate
from mbs.model.model import Model
from mbs.model.records import Guide
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.port_inputs import new_port
from mbs.vehicle.steering.steering_interface import RACK
from mbs.vehicle.steering.steering_section import COLUMN_STICK


def by_port(b: CarBuilder, most: float, text: str) -> Guide:
    """The travel of the rack, m, that a port asks for; `most`: to each side, m; `text`: what the port is."""
    port = new_port(b, "steering_rack_demand", -most, most, "m", text)
    return b.m.guide_input("rack", input=port, frequency=b.ports.rack_frequency, unit="m")


def by_table(m: Model, held: Guide, rows: ArrayLike) -> Guide:
    """The travel of the rack, m, by rows of angle, rad, and travel; `held`: the angle of the steering wheel."""
    return m.guide_table("rack", held, rows, unit="m")


def column_friction(m: Model, held: Guide, per_radian: float, torque: float) -> None:
    """Friction at a steering wheel, `torque` in N m, that goes with `held`, which is `per_radian` of its angle."""
    wheel = m.shaft("steering wheel")
    m.drive("steering column", wheel.affine * per_radian, held)
    m.add(CoordinateFriction(torque, *COLUMN_STICK).record("steering friction", wheel.affine))


def travel(m: Model, rack: Guide) -> Coordinate:
    """The travel of the rack as a coordinate, m."""
    way = m.travel(RACK)
    m.drive(RACK, way.affine, rack)
    return way
