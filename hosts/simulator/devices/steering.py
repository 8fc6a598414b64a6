"""From the turn of a real steering wheel to the input that steers the car."""

import math
from dataclasses import dataclass

from hosts.simulator.devices.mapping import ANGLE

ANGLE_MAX = "vehicle.steering_wheel_angle_max"
_USUAL = 900.0
"""Degrees from end to end of a device that does not say, where the car wants an angle and does not say its largest."""


@dataclass(frozen=True)
class Steering:
    """How a car is steered by a device: to an angle, or to a share of full steering."""

    angle_max: float | None
    """Angle of the car's steering wheel at full steering, rad, if it is known."""
    by_angle: bool = False
    """Whether the car has the input `steering_wheel_angle_demand` and no `steering`."""

    @property
    def says_no_angle(self) -> bool:
        """Whether the ends of the device are full steering because the car reports no angle."""
        return self.angle_max is None and not self.by_angle

    def share(self, turn: float, rotation: float) -> float:
        """Steering from -1 to 1.

        `turn`: of the device, from -1 to 1, positive to the left; `rotation`: degrees of the device from end to end; 0:
        its ends are full steering.
        """
        if not rotation or not self.angle_max:
            return turn
        return max(-1.0, min(1.0, turn * 0.5 * math.radians(rotation) / self.angle_max))

    def want(self, turn: float, rotation: float) -> tuple[str, float]:
        """Name and value of the car's input; see `share`."""
        share = self.share(turn, rotation)
        if not self.by_angle:
            return "steering", share
        return ANGLE, share * (self.angle_max or 0.5 * math.radians(rotation or _USUAL))
