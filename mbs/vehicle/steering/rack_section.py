"""Base class of the sections of steerings with a rack in a car file."""

import math

from mbs.model.joint_ends import End
from mbs.model.records import DrivingFunction
from mbs.vehicle.axes import LEFT
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.quantities import Frequency, RackPerTurn, RoadWheelAngle, Travel
from mbs.vehicle.side import Point, Side, TieRodEnd
from mbs.vehicle.steering.steering_section import SteeringSection


class RackSection(SteeringSection):
    """Rack and steering wheel."""

    rack_travel: Travel
    """Travel of the rack to each side at steering = 1."""
    rack_per_turn: RackPerTurn
    """Travel of the rack per turn of the steering wheel."""
    frequency: Frequency
    """Of the critically damped follower between the demanded angle and the rack or steering wheel."""
    front_wheel_angle_max: RoadWheelAngle
    """Mean steering angle of the front wheels at full travel."""

    @property
    def wheel_angle_max(self) -> float:
        """Angle of the steering wheel at full travel, rad."""
        return 2.0 * math.pi * self.rack_travel / self.rack_per_turn

    @property
    def full(self) -> float:
        """Travel of the rack at full lock, m."""
        return self.rack_travel

    @property
    def lateral_travel(self) -> tuple[str, float]:
        """Key path and travel of the rack at full lock, m."""
        return self.key("rack_travel"), self.rack_travel

    def wheel_at(self, motion: float) -> tuple[float, float]:
        """As in the base class, by the travel per turn."""
        rate = 2.0 * math.pi / self.rack_per_turn
        return rate * motion, rate

    def ends(self, b: CarBuilder, guide: DrivingFunction, way: float) -> TieRodEnd:
        """Ends of the rack, moved by a driving function."""
        return rack_ends(b, guide)

    def travel_text(self, way: float) -> str:
        """Description of the travel. `way`: as in `signed`."""
        return f"rack travel, positive to the left (turns the wheels {'left' if way > 0.0 else 'right'})"


def rack_ends(b: CarBuilder, guide: DrivingFunction) -> TieRodEnd:
    """Ends of a massless rack. `guide`: its travel, m, positive to the left."""

    def end(side: Side, point: Point) -> End:
        return b.m.slide(f"rack end {side.wheel}", b.chassis.body, point=point, direction=LEFT, guide=guide)

    return end
