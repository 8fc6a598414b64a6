"""The steering input of the car from the position of a steering wheel."""

import math
from dataclasses import dataclass

from hosts.simulator.devices.mapping import ANGLE

ANGLE_MAX = "vehicle.steering_wheel_angle_max"
_DEFAULT_ROTATION = 900.0
"""Rotation of a device from end to end, degrees, if neither it nor the largest angle of the car is known."""


@dataclass(frozen=True)
class Steering:
    """The steering of a car by a device: to an angle, or to a fraction of full steering."""

    angle_max: float | None
    """Steering wheel angle of the car at full steering, rad, if known."""
    by_angle: bool = False
    """Whether the car has the input `steering_wheel_angle_demand` and no `steering`."""

    @property
    def lacks_angle(self) -> bool:
        """Whether the ends of the device are full steering because the angle of the car is not known."""
        return self.angle_max is None and not self.by_angle

    def fraction(self, turn: float, rotation: float) -> float:
        """Steering from -1 to 1.

        `turn`: position of the device, from -1 to 1, positive to the left; `rotation`: rotation of the device from end
        to end, degrees; 0: its ends are full steering.
        """
        if not rotation or not self.angle_max:
            return turn
        return max(-1.0, min(1.0, turn * 0.5 * math.radians(rotation) / self.angle_max))

    def want(self, turn: float, rotation: float) -> tuple[str, float]:
        """Name and value of the input of the car; see `fraction`."""
        fraction = self.fraction(turn, rotation)
        if not self.by_angle:
            return "steering", fraction
        return ANGLE, fraction * (self.angle_max or 0.5 * math.radians(rotation or _DEFAULT_ROTATION))
