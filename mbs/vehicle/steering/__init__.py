"""Templates of steerings: a new one is a file here and a member of `Steering`."""

from __future__ import annotations

from mbs.vehicle.steering.rack_by_angle import RackByAngle

Steering = RackByAngle

__all__ = ["Steering"]
