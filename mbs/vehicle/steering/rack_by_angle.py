"""Steering rack driven by the angle of the steering wheel, without compliance."""

import math
from collections.abc import Iterator
from contextlib import suppress
from functools import cached_property
from typing import Any, ClassVar, Literal

from pydantic import ConfigDict, model_validator

from mbs.model.coordinate import Coordinate
from mbs.model.joints.joint import Joint
from mbs.model.model import Model
from mbs.model.records import DrivingFunction, Input
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.inputs import new_port
from mbs.vehicle.quantities import PrescribedFriction
from mbs.vehicle.steering.rack_section import RackSection, rack_ends
from mbs.vehicle.steering.rack_table import SLOPE_TOLERANCE, RackTable, Rows, table_faults
from mbs.vehicle.steering.steering_outputs import RACK_FORCE, WHEEL_ANGLE, demand_outputs, tie_ratio, wheel_outputs
from mbs.vehicle.steering.steering_section import Steered, column_friction

RACK = "rack travel"
"""Name of the coordinate of the rack, and of its drive."""


def _make_optional(schema: dict[str, Any]) -> None:
    """Make `rack_per_turn` optional in the JSON schema, as a table can give it."""
    schema["required"].remove("rack_per_turn")


class RackByAngle(RackSection):
    """Rack that follows the angle of the steering wheel."""

    model_config = ConfigDict(json_schema_extra=_make_optional)

    rack_port: ClassVar[str] = "rack_position"

    kind: Literal["rack_by_angle"]
    """Names this template."""
    friction: PrescribedFriction = 0.0
    """Friction of rack and column, at the steering wheel."""
    rack_by_wheel_angle: Rows | None = None
    """Rows of the angle of the steering wheel, deg, and the travel of the rack, mm, from straight ahead, [0, 0], to
    full lock, a monotone cubic between them, the same to both sides; stretched along the angle so that straight ahead
    it has rack_per_turn, which may be left out."""

    @model_validator(mode="before")
    @classmethod
    def _per_turn_of_table(cls, data: Any) -> Any:
        """Set a missing `rack_per_turn` from the first two rows of the table, the slope straight ahead."""
        with suppress(KeyError, TypeError, ValueError, IndexError, ZeroDivisionError):
            angle, travel = data["rack_by_wheel_angle"][1]
            return {"rack_per_turn": 0.36 * travel / angle, **data}
        return data

    def faults(self) -> Iterator[str]:
        """Yield a sentence if the table does not rise or does not reach full lock."""
        if self.rack_by_wheel_angle is not None:
            key, travel = self.key("rack_by_wheel_angle"), self.key("rack_travel")
            yield from table_faults(key, self.rack_by_wheel_angle, travel, self.rack_travel)

    def oddities(self) -> Iterator[str]:
        """Yield a sentence if the angles of the table are scaled."""
        table = self.by_table
        if table is not None and abs(table.factor - 1.0) > SLOPE_TOLERANCE:
            turn = 2.0 * math.pi * table.slope
            yield (
                f"{self.key('rack_by_wheel_angle')} has {turn:.6g} m of rack travel per turn straight ahead, and "
                f"{self.key('rack_per_turn')} is {self.rack_per_turn:g} m; the angles of the table are divided by "
                f"{table.factor:.6g}. To keep them unchanged write {turn:.6g}."
            )

    def port_faults(self) -> Iterator[str]:
        """Yield a sentence if there is a table although the port gives the travel of the rack."""
        if self.by_table is not None:
            yield (
                f"{self.key('rack_by_wheel_angle')} is there, and ports.steering asks for the travel of the rack "
                "itself; leave one of them out."
            )

    @cached_property
    def by_table(self) -> RackTable | None:
        """Curve of the table; None if the ratio is constant."""
        if self.rack_by_wheel_angle is None:
            return None
        return RackTable(self.rack_by_wheel_angle, self.rack_per_turn / (2.0 * math.pi))

    @property
    def wheel_angle_max(self) -> float:
        """Angle of the steering wheel at full lock, rad; by the table if there is one."""
        return super().wheel_angle_max if self.by_table is None else self.by_table.at(self.rack_travel)[0]

    def wheel_at(self, motion: float) -> tuple[float, float]:
        """Angle of the steering wheel, rad, and its slope at a travel of the rack; by the table if there is one."""
        return super().wheel_at(motion) if self.by_table is None else self.by_table.at(motion)

    def build(self, b: CarBuilder, way: float) -> Steered:
        """Add the rack. `way`: as in `signed`."""
        m, turn = b.m, way * 2.0 * math.pi
        per_radian = way * self.rack_per_turn / (2.0 * math.pi)
        text, by_table = self.travel_text(way), self.by_table
        demand: Input | None = None
        if b.ports.steering is not None:
            port = new_port(
                b, "steering_rack_demand", -self.rack_travel, self.rack_travel, "m", f"{text}, that is asked for"
            )
            rack = held = m.guide_input("rack", input=port, frequency=b.ports.rack_frequency, unit="m")
        else:
            demand = self.angle_demand(m)
            full, name, unit = way * self.rack_travel, "rack", "m"
            if by_table is not None:
                per_radian, turn = by_table.factor, 2.0 * math.pi * by_table.slope
                full, name, unit = by_table.angle(self.rack_travel), "steering wheel", "rad"
            rack = held = m.guide_inputs(
                name,
                inputs=(b.inputs["steering"], demand),
                gains=(full, per_radian),
                limits=(-abs(full), abs(full)),
                frequency=self.frequency,
                unit=unit,
            )
            if by_table is not None:
                rack = m.guide_table("rack", held, by_table.rows * (1.0, way), unit="m")
        if self.friction > 0.0:
            column_friction(m, held, per_radian, self.friction)

        def outputs() -> None:
            m.sense_guide("steering_rack", rack, description=text)
            scale = turn / self.rack_per_turn
            m.sense_guide("steering_wheel_angle", held, scale=scale, unit="rad", description=WHEEL_ANGLE)

        def torque_outputs() -> None:
            wheel_outputs(m, held, per_radian, 1.0 / per_radian)
            rods = _tie_rods(m, rack)
            m.sense_guide("steering_rack_force", rack, "force", joints=rods, scale=-1.0, description=RACK_FORCE)
            if demand is not None:
                demand_outputs(m, demand, held, 1.0 / per_radian)
            if self.friction == 0.0:  # with friction the ratio is in an equation, which has no parameters
                tie_ratio(b, self, "rack_per_turn", held, turn, inverse=False)

        def travel() -> Coordinate:
            coordinate = m.travel(RACK)
            m.drive(RACK, coordinate.affine, rack)
            return coordinate

        return Steered(rack_ends(b, rack), outputs, torque_outputs, travel)


def _tie_rods(m: Model, guide: DrivingFunction) -> list[Joint]:
    """Rods with an end moved by a driving function, or the drive of the rack if it is a coordinate.

    `m`: model with the suspension.
    """
    return [
        joint
        for joint in m.joints
        if (joint.type == "distance" or joint.name == RACK)
        and any(t.guide == guide.index for e in joint.equations for t in e.guides)
    ]
