"""Double wishbones whose links move in planes across the car, solved in closed form as four-bar linkages."""

from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.optimize import brentq

from mbs.vehicle import load

CENTRE = 0.2489  # m
TRACK_HALF = 0.67  # m


@dataclass(frozen=True)
class FourBar:
    """Pivots and ball joints (y, z) of the left side at the design position, m."""

    lower_pivot: tuple[float, float]
    lower_ball: tuple[float, float]
    upper_pivot: tuple[float, float]
    upper_ball: tuple[float, float]

    def car(self, **more):
        """The prototype with these wishbones; its tie rod is a copy of the lower arm, so that nothing steers."""
        return _car(self, tuple(more.items()))

    def points(self):
        """Hard points by the names of a car file."""
        (ly, lz), (by, bz), (uy, uz), (vy, vz) = (self.lower_pivot, self.lower_ball, self.upper_pivot, self.upper_ball)
        return {
            "lower_pivot_front": [0.15, ly, lz],
            "lower_pivot_rear": [-0.15, ly, lz],
            "upper_pivot_front": [0.13, uy, uz],
            "upper_pivot_rear": [-0.13, uy, uz],
            "lower_ball_joint": [0.0, by, bz],
            "upper_ball_joint": [0.0, vy, vz],
            "tie_rod_inner": [-0.125, ly, lz],
            "tie_rod_outer": [-0.125, by, bz],
        }

    def upright(self, angle):
        """Lower ball joint (y, z), m, and rotation of the upright about x, rad, for an angle of the lower arm, rad."""
        pivot, ball, top, head = (
            np.array(p) for p in (self.lower_pivot, self.lower_ball, self.upper_pivot, self.upper_ball)
        )
        low = pivot + np.linalg.norm(ball - pivot) * np.array([np.cos(angle), np.sin(angle)])
        post, arm = np.linalg.norm(head - ball), np.linalg.norm(head - top)
        gap = top - low
        distance = np.linalg.norm(gap)
        along = (distance**2 + post**2 - arm**2) / (2.0 * distance)
        across = np.sqrt(post**2 - along**2)
        unit = gap / distance
        head_now = low + along * unit + across * np.array([unit[1], -unit[0]])  # outboard of the line to the pivot
        drawn, now = head - ball, head_now - low
        rotation = np.arctan2(drawn[0] * now[1] - drawn[1] * now[0], drawn @ now)
        return low, rotation

    def wheel(self, travel):
        """Centre (y, z), m, rotation about x, rad, and contact (y, z), m, of the left wheel at a travel, m."""
        low, rotation = self._upright_at(travel)
        centre = low + _turned(np.subtract((TRACK_HALF, CENTRE), self.lower_ball), rotation)
        return centre, rotation, centre + _turned((0.0, -CENTRE), rotation)

    def pole(self, travel):
        """Instantaneous centre (y, z) of the upright, m: the intersection of the lines of both arms. `travel`: m."""
        low, rotation = self._upright_at(travel)
        head = low + _turned(np.subtract(self.upper_ball, self.lower_ball), rotation)
        first, second = low - self.lower_pivot, head - self.upper_pivot
        share = np.linalg.solve(np.column_stack([first, -second]), np.subtract(self.upper_pivot, self.lower_pivot))
        return np.array(self.lower_pivot) + share[0] * first

    def _upright_at(self, travel):
        """As `upright`, where the wheel centre has risen by a travel, m."""
        gap = np.subtract((TRACK_HALF, CENTRE), self.lower_ball)

        def excess(angle):
            low, rotation = self.upright(angle)
            return (low + _turned(gap, rotation))[1] - CENTRE - travel

        drawn = np.arctan2(*np.subtract(self.lower_ball, self.lower_pivot)[::-1])
        return self.upright(brentq(excess, drawn - 0.8, drawn + 0.8, xtol=1e-14))


def _turned(vector, angle):
    """A vector (y, z), turned about x."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]])


@cache
def _car(linkage, more):
    moved = {f"front.suspension.points.{name}": list(value) for name, value in (linkage.points() | dict(more)).items()}
    return load("prototype").changed(moved | {"chassis.frame.or_rigid": True})  # the frame has other joints
