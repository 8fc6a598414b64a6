"""Parts of steerings with a prescribed motion: guides by a port or a table, friction of the column."""

from numpy.typing import ArrayLike

from mbs.elements.coordinate_friction import CoordinateFriction
from mbs.model.coordinate import Coordinate
from mbs.model.model import Model
from mbs.model.records import Guide
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.inputs import new_port
from mbs.vehicle.steering.steering_interface import RACK
from mbs.vehicle.steering.steering_section import COLUMN_STICK


def by_port(b: CarBuilder, limit: float, text: str) -> Guide:
    """Add a port for the travel of the rack; return the guide, m. `limit`: largest travel to each side, m; `text`:
    description."""
    port = new_port(b, "steering_rack_demand", -limit, limit, "m", text)
    return b.m.guide_input("rack", input=port, frequency=b.ports.rack_frequency, unit="m")


def by_table(m: Model, wheel_guide: Guide, rows: ArrayLike) -> Guide:
    """Add a guide of the rack's travel, m, as a table of another guide. `rows`: angle, rad, and travel, m, (n, 2)."""
    return m.guide_table("rack", wheel_guide, rows, unit="m")


def column_friction(m: Model, guide: Guide, per_radian: float, torque: float) -> None:
    """Add friction of `torque`, N m, to a steering wheel. `guide`: `per_radian` times the angle of the wheel, rad."""
    wheel = m.shaft("steering wheel")
    m.drive("steering column", wheel.affine * per_radian, guide)
    m.add(CoordinateFriction(torque, *COLUMN_STICK).record("steering friction", wheel.affine))


def travel(m: Model, rack: Guide) -> Coordinate:
    """Add a coordinate with the travel of the rack, m."""
    coordinate = m.travel(RACK)
    m.drive(RACK, coordinate.affine, rack)
    return coordinate
