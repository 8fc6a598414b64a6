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

    target_speed: float
    """Target speed of the driver, km/h."""
    result: Result
    driver: str
    course: Course
    """In its own axes."""
    size: tuple[float, float]
    """Length and width of the car's outline, m."""
    pose: tuple[float, float, float]
    """x, y, yaw of the axes of the course in earth axes, m and rad."""
    after: NDArray[np.bool_]
    """Shape (n,): whether the course has begun."""
    reason: str
    """Reason of an early end of the run, see `StopConditions`; empty: none."""
    release: float
    """Position at which the pedals are released, m into the first lane; infinite: never."""

    @cached_property
    def positions(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """x, y and yaw in the axes of the course after its start, m and rad, shape (m,)."""
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
        """Least distance of the outline from cones, m; negative: a cone is hit; NaN: the course has not begun."""
        if not self.after.any():
            return math.nan
        return float(clearance(self.course, *self.positions, *self.size).min())

    @cached_property
    def not_driven(self) -> str:
        """The lanes that the car has not driven, as a clause; empty: none."""
        return self.course.not_driven(self.positions[0], self.size[0])

    @property
    def is_clean(self) -> bool:
        """Whether the car has driven the whole course without hitting a cone."""
        return not self.not_driven and self.least_clearance > 0.0 and not self.reason

    @property
    def failure(self) -> str:
        """Why the passage is not clean, as a clause; empty: it is clean."""
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
        """Value of an output when the car's front reaches a position x of the course, m; NaN if it does not."""
        front = self.positions[0] + 0.5 * self.size[0]
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
        """Outlines of the car every three metres with gaps between them, shape (2, n)."""
        x, y, yaw = self.positions
        distance = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
        picked = np.unique(np.searchsorted(distance, np.arange(0.0, distance[-1], 3.0)))
        corners = outline(x[picked], y[picked], yaw[picked], *self.size)
        gap = np.full((len(picked), 1, 2), math.nan)
        return np.concatenate([corners, corners[:, :1], gap], axis=1).reshape(-1, 2).T
