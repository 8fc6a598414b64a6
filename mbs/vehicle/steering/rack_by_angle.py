"""Rack that the steering wheel moves without compliance."""

from __future__ import annotations

import math
from typing import Literal

from mbs.model.ends import End
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.quantities import Frequency, RackPerTurn, RoadWheelAngle, Travel
from mbs.vehicle.section import Section
from mbs.vehicle.side import Point, Side
from mbs.vehicle.steering.steered import Steered


class RackByAngle(Section):
    """Rack that follows the angle of the steering wheel."""

    kind: Literal["rack_by_angle"]
    """Names this template."""
    rack_travel: Travel
    """Travel of the rack to each side at steering = 1."""
    rack_per_turn: RackPerTurn
    """Travel of the rack per turn of the steering wheel."""
    frequency: Frequency
    """Of the critically damped follower between input and rack."""
    front_wheel_angle_max: RoadWheelAngle
    """Mean steering angle of the front wheels at full travel."""

    @property
    def wheel_angle_max(self) -> float:
        """Angle of the steering wheel at full travel, rad."""
        return 2.0 * math.pi * self.rack_travel / self.rack_per_turn

    def build(self, b: CarBuilder, way: float) -> Steered:
        """Add the rack.

        Parameters
        ----------
        b : CarBuilder
            The car so far.
        way : float
            1 where the rack moves to the left to steer to the left, -1 where it moves to the right.

        Returns
        -------
        Steered
            Ends of the rack, and its outputs.
        """
        rack = b.m.guide_input(
            "rack", input=b.inputs["steering"], gain=way * self.rack_travel, frequency=self.frequency, unit="m"
        )

        def end(side: Side, point: Point) -> End:
            return b.m.slide(
                f"rack end {side.wheel}", b.chassis.body, point=point, direction=(0.0, 1.0, 0.0), guide=rack
            )

        def outputs() -> None:
            turned = "left" if way > 0.0 else "right"
            b.m.sense_guide(
                "steering_rack", rack, description=f"rack travel, positive to the left (turns the wheels {turned})"
            )
            b.m.sense_guide(
                "steering_wheel_angle",
                rack,
                scale=way * 2.0 * math.pi / self.rack_per_turn,
                unit="rad",
                description="angle of the steering wheel, positive to the left",
            )

        return Steered(end, outputs)
