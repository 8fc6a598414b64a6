"""Passages of a course of cones."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hosts.common.angles import angle_difference
from hosts.driving.course import Course
from hosts.driving.result import Result
from hosts.measures.clearance import clearance, outline


@dataclass(frozen=True)
class Passage:
    """One drive through a course."""

    wanted: float
    """Speed of the driver, km/h."""
    result: Result
    driver: str
    course: Course
    """In axes of its own."""
    size: tuple[float, float]
    """Length and width of the car's outline, m."""
    pose: tuple[float, float, float]
    """x, y, yaw of these axes, earth, m and rad."""
    after: NDArray[np.bool_]
    """Shape (n,): where the course has begun."""
    reason: str
    """Why the run ended early; empty: it did not."""
    release: float
    """Where the pedals are released, m into the first lane; infinite: nowhere."""

    @cached_property
    def place(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """x, y and yaw in the axes of the course since it has begun, of shape (m,)."""
        x0, y0, yaw0 = self.pose
        dx, dy = self.result["chassis.x"][self.after] - x0, self.result["chassis.y"][self.after] - y0
        yaw = angle_difference(self.result["chassis.yaw"][self.after], yaw0)
        return (
            math.cos(yaw0) * dx + math.sin(yaw0) * dy,
            math.cos(yaw0) * dy - math.sin(yaw0) * dx,
            yaw,
        )

    @cached_property
    def least_clearance(self) -> float:
        """Least distance of the outline from cones, m; negative: hit; NaN: the course has not begun."""
        if not self.after.any():
            return math.nan
        return float(clearance(self.course, *self.place, *self.size).min())

    @cached_property
    def not_driven(self) -> str:
        """What of the lanes the car has not driven; empty: it has driven all."""
        return self.course.not_driven(self.place[0], self.size[0])

    @property
    def clean(self) -> bool:
        """Whether the car is through without a cone."""
        return not self.not_driven and self.least_clearance > 0.0 and not self.reason

    @property
    def why(self) -> str:
        """Why it is not clean, as the end of a sentence; empty: it is."""
        if not self.after.any():
            return f"the speed was not reached: it is {3.6 * self.result['speed'][-1]:.4g} km/h"
        if self.reason in ("spun", "rolled"):
            return f"the car has {self.reason}"
        if self.least_clearance <= 0.0:
            return f"a cone is hit by {-self.least_clearance:.3g} m"
        if self.result.refusal:
            return self.result.refusal
        return self.not_driven and f"the car does not come through: {self.not_driven}"

    def at(self, quantity: str, x: float) -> float:
        """Value of an output when the car's front is at a place of the course; NaN if it is not there."""
        front = self.place[0] + 0.5 * self.size[0]
        indices = np.flatnonzero(front >= x)
        return float(self.result[quantity][self.after][indices[0]]) if len(indices) else math.nan

    @cached_property
    def lanes(self) -> NDArray[np.float64]:
        """Edges of the lanes with gaps between them, shape (2, n)."""
        points = []
        for gate in self.course.gates:
            for edge in (gate.y_left, gate.y_right):
                points += [(gate.x_start, edge), (gate.x_end, edge), (math.nan, math.nan)]
        return np.array(points).T

    @cached_property
    def outlines(self) -> NDArray[np.float64]:
        """The car every three metres, shape (2, n)."""
        x, y, yaw = self.place
        distance = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
        picked = np.unique(np.searchsorted(distance, np.arange(0.0, distance[-1], 3.0)))
        corners = outline(x[picked], y[picked], yaw[picked], *self.size)
        gap = np.full((len(picked), 1, 2), math.nan)
        return np.concatenate([corners, corners[:, :1], gap], axis=1).reshape(-1, 2).T
