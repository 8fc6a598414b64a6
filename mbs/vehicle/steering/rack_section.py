"""What every steering with a rack has in a car file."""

from __future__ import annotations

import math

from mbs.vehicle.quantities import Frequency, RackPerTurn, RoadWheelAngle, Travel
from mbs.vehicle.section import Section

COLUMN_STICK = 200.0, 5.0  # N m/rad, N m s/rad of a column that sticks: 1 N m of friction gives by 5 mrad


class RackSection(Section):
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

    def wheel_at(self, travel: float) -> tuple[float, float]:
        """Angle of the steering wheel, rad, and its change per travel of the rack, rad/m.

        Parameters
        ----------
        travel : float
            Of the rack, m, to the side to which it steers to the left.
        """
        rate = 2.0 * math.pi / self.rack_per_turn
        return rate * travel, rate

    @property
    def on_flexible_chassis(self) -> bool:
        """Whether the chassis may bend or have ports."""
        return True

    @property
    def moving_mass(self) -> float:
        """Mass of what is a body of its own, kg."""
        return 0.0

    def travel_text(self, way: float) -> str:
        """Description of the travel.

        Parameters
        ----------
        way : float
            1 where the rack moves to the left to steer to the left, else -1.
        """
        return f"rack travel, positive to the left (turns the wheels {'left' if way > 0.0 else 'right'})"
