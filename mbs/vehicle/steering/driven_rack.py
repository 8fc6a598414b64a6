"""Parts of steerings with a prescribed rack: motion by a port or by a table, column friction."""

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
    """Travel of the rack, m, from a port. `most`: limit to each side, m; `text`: description of the port."""
    port = new_port(b, "steering_rack_demand", -most, most, "m", text)
    return b.m.guide_input("rack", input=port, frequency=b.ports.rack_frequency, unit="m")


def by_table(m: Model, held: Guide, rows: ArrayLike) -> Guide:
    """Travel of the rack, m, from the angle `held` of the steering wheel. `rows`: angle, rad, and travel, m, (n, 2)."""
    return m.guide_table("rack", held, rows, unit="m")


def column_friction(m: Model, held: Guide, per_radian: float, torque: float) -> None:
    """Add friction of `torque`, N m, to a steering wheel. `held`: a guide that is `per_radian` times its angle, rad."""
    wheel = m.shaft("steering wheel")
    m.drive("steering column", wheel.affine * per_radian, held)
    m.add(CoordinateFriction(torque, *COLUMN_STICK).record("steering friction", wheel.affine))


def travel(m: Model, rack: Guide) -> Coordinate:
    """A coordinate that is driven to the travel of the rack, m."""
    coordinate = m.travel(RACK)
    m.drive(RACK, coordinate.affine, rack)
    return coordinate
