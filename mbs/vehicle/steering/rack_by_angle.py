"""Rack that the steering wheel moves without compliance."""

from __future__ import annotations

import math
from typing import Literal

from mbs.elements.coordinate_friction import CoordinateFriction
from mbs.model.coordinate import Coordinate
from mbs.model.ends import End
from mbs.model.records import Input
from mbs.vehicle.axes import LEFT
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.quantities import PrescribedFriction
from mbs.vehicle.side import Point, Side
from mbs.vehicle.steering.driver import RACK_FORCE, WHEEL_SPEED, WHEEL_TORQUE, angle_demand, demand_outputs
from mbs.vehicle.steering.rack_section import COLUMN_STICK, RackSection
from mbs.vehicle.steering.ratio import tie_ratio
from mbs.vehicle.steering.steered import RACK, Steered, tie_rods


class RackByAngle(RackSection):
    """Rack that follows the angle of the steering wheel."""

    kind: Literal["rack_by_angle"]
    """Names this template."""
    friction: PrescribedFriction = 0.0
    """Friction of rack and column, at the steering wheel."""

    def build(self, b: CarBuilder, way: float) -> Steered:
        """Add the rack.

        Parameters
        ----------
        way : float
            1 where the rack moves to the left to steer to the left, -1 where it moves to the right.

        Returns
        -------
        Steered
            Ends of the rack, and its outputs.
        """
        m, per_radian = b.m, way * self.rack_per_turn / (2.0 * math.pi)
        demand: Input | None = None
        if b.ports.steering is None:
            demand = angle_demand(m, self.wheel_angle_max)
            rack = m.guide_inputs(
                "rack",
                inputs=(b.inputs["steering"], demand),
                gains=(way * self.rack_travel, per_radian),
                limits=(-self.rack_travel, self.rack_travel),
                frequency=self.frequency,
                unit="m",
            )
        else:
            most = self.rack_travel
            port = b.port("steering_rack_demand", -most, most, "m", f"{self.travel_text(way)}, that is asked for")
            rack = m.guide_input("rack", input=port, frequency=b.ports.rack_frequency, unit="m")
        if self.friction > 0.0:
            wheel = m.shaft("steering wheel")
            m.drive("steering column", wheel.affine * per_radian, rack)
            friction = CoordinateFriction(self.friction, *COLUMN_STICK)
            m.add(friction.record("steering friction", wheel.affine))

        def end(side: Side, point: Point) -> End:
            return m.slide(f"rack end {side.wheel}", b.chassis.body, point=point, direction=LEFT, guide=rack)

        def travel() -> Coordinate:
            way_of_rack = m.travel(RACK)
            m.drive(RACK, way_of_rack.affine, rack)
            return way_of_rack

        def outputs() -> None:
            m.sense_guide("steering_rack", rack, description=self.travel_text(way))
            m.sense_guide(
                "steering_wheel_angle",
                rack,
                scale=way * 2.0 * math.pi / self.rack_per_turn,
                unit="rad",
                description="angle of the steering wheel, positive to the left",
            )

        def torque_outputs() -> None:
            m.sense_guide(
                "steering_wheel_torque", rack, "force", scale=per_radian, unit="N.m", description=WHEEL_TORQUE
            )
            m.sense_guide(
                "steering_wheel_speed", rack, order=1, scale=1.0 / per_radian, unit="rad/s", description=WHEEL_SPEED
            )
            m.sense_guide(
                "steering_rack_force", rack, "force", joints=tie_rods(m, rack), scale=-1.0, description=RACK_FORCE
            )
            if demand is not None:
                demand_outputs(m, demand, rack, 1.0 / per_radian)
            if self.friction == 0.0:  # with friction the ratio is in an equation, which no parameter writes
                tie_ratio(b, self, rack, way)

        return Steered(end, outputs, torque_outputs, travel)
