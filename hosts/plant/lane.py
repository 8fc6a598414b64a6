"""A lane on the ground, and the position of a car relative to it: offset, heading error, curvature ahead."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline, PPoly

from ali3.message_text import brief
from hosts.common.arguments import array_of, positive
from hosts.common.errors import HostError
from hosts.common.numbers import is_finite
from hosts.driving.course import Course

SPACING = 0.5  # m between points of the centre line, among which the nearest is the first estimate
REACH = 50.0  # m along the lane, before and behind the last place, in which the nearest point is searched
ITERATIONS = 3  # largest number of iterations of Newton's method from this estimate
TOLERANCE = 1e-7  # m: the last iteration moves less
FARTHEST = 1e9  # m, of coordinates and ways along a lane: doubles still resolve a micrometre there


class Lane:
    """The centre line of a lane by its length.

    Parameters
    ----------
    points : array_like, shape (n, 2), n >= 4
        Of the centre line in the direction of travel, x and y, m; a cubic spline goes through them. Where the last is
        the first the lane is closed.
    width : float
        m.

    Raises
    ------
    HostError
        They are no line, or the width is not a positive number.
    """

    def __init__(self, points: ArrayLike, width: float = 3.5) -> None:
        p = _numbers(points, "The points of a lane")
        if p.ndim != 2 or p.shape[0] < 4 or p.shape[1] != 2:
            raise HostError(f"The points of a lane have the shape {p.shape}; they must be four or more (x, y).")
        chords = np.hypot(*np.diff(p, axis=0).T)
        if not (chords > 0.0).all():
            raise HostError(f"Point {int(np.argmin(chords)) + 1} of a lane lies on the one before it.")
        self.width = positive(width, "The width of a lane", "m")
        self.closed = bool((p[0] == p[-1]).all())
        arc_length = np.concatenate([[0.0], np.cumsum(chords)])
        self.length = float(arc_length[-1])
        line = CubicSpline(arc_length, p, bc_type="periodic" if self.closed else "natural")
        # One polynomial of position and its two derivatives: a call costs as much for six numbers as for two.
        lower = [np.pad(line.derivative(order).c, ((order, 0), (0, 0), (0, 0))) for order in range(3)]
        self._line = PPoly(np.concatenate(lower, axis=2), line.x)
        self._ways = np.linspace(0.0, self.length, max(4, round(self.length / SPACING)) + 1)
        self._places = self._line(self._ways)[:, :2]
        self._last: float | None = None  # way of the last place

    @classmethod
    def of_course(cls, course: Course, length: float, width: float = 3.5) -> Lane:
        """The lane along the path of a course of cones. `length`: along x, m."""
        length = positive(length, "The length of a lane", "m")
        x = np.linspace(0.0, length, max(4, round(length)) + 1)
        return cls(np.column_stack([x, [course.path(float(each))[0] for each in x]]), width)

    def forget(self) -> None:
        """Look for the place of the next call along the whole lane."""
        self._last = None

    def place(self, x: float, y: float) -> float:
        """Way along the lane of the point of its centre line that is nearest, near that of the last call, m.

        Raises `HostError`: the place is not finite.
        """
        if not (is_finite(x) and is_finite(y)):
            raise HostError(f"The place on a lane is ({brief(x)}, {brief(y)}); it must be two finite numbers.")
        distance = np.hypot(self._places[:, 0] - x, self._places[:, 1] - y)
        if self._last is not None:
            separation = np.abs(self._ways - self._last)
            separation = np.minimum(separation, self.length - separation) if self.closed else separation
            distance = np.where(separation <= REACH, distance, np.inf)
        s = float(self._ways[int(np.argmin(distance))])
        for _ in range(ITERATIONS):
            lane_x, lane_y, ahead_x, ahead_y, bend_x, bend_y = self._line(s).tolist()
            error_x, error_y = lane_x - x, lane_y - y
            slope = ahead_x**2 + ahead_y**2 + error_x * bend_x + error_y * bend_y
            if slope <= 0.0:
                break
            change = (error_x * ahead_x + error_y * ahead_y) / slope
            s = self._on(s - change)
            if abs(change) < TOLERANCE:
                break
        self._last = s
        return s

    @property
    def way(self) -> float:
        """Way along the lane of the last place, m."""
        return 0.0 if self._last is None else self._last

    def _on(self, s: float) -> float:
        return s % self.length if self.closed else min(max(s, 0.0), self.length)

    def sense(
        self, x: float, y: float, yaw: float, ahead: ArrayLike = (10.0, 20.0, 30.0)
    ) -> tuple[float, float, NDArray[np.float64]]:
        """What a car at a place knows of the lane.

        Parameters
        ----------
        x, y, yaw : float
            Of the car, m and rad.
        ahead : array_like of float
            Distances along the lane from there, m.

        Returns
        -------
        offset : float
            Of the car from the centre line, positive to its left, m.
        heading : float
            Of the car from the direction of the lane, positive to the left, between -pi and pi, rad.
        curvature : ndarray of float
            Of the lane at the distances ahead, positive to the left, 1/m.
        """
        if not is_finite(yaw):
            raise HostError(f"The heading on a lane is {brief(yaw)}; it must be a finite number, in rad.")
        s = self.place(x, y)
        lane_x, lane_y, ahead_x, ahead_y = self._line(s)[:4]
        direction = np.arctan2(ahead_y, ahead_x)
        offset = np.cos(direction) * (y - lane_y) - np.sin(direction) * (x - lane_x)
        heading = (yaw - direction + np.pi) % (2.0 * np.pi) - np.pi
        return float(offset), float(heading), self.curvature(s + _numbers(ahead, "The distances ahead"))

    def curvature(self, ways: ArrayLike) -> NDArray[np.float64]:
        """Curvature of the centre line at ways along it, positive to the left, 1/m; beyond an open end that there."""
        s = _numbers(ways, "The ways along a lane")
        s = s % self.length if self.closed else np.clip(s, 0.0, self.length)
        ahead_x, ahead_y, bend_x, bend_y = np.moveaxis(self._line(s), -1, 0)[2:]
        results: NDArray[np.float64] = (ahead_x * bend_y - ahead_y * bend_x) / np.hypot(ahead_x, ahead_y) ** 3
        return results


def _numbers(values: ArrayLike, subject: str) -> NDArray[np.float64]:
    """Numbers of a size that a lane has. `subject`: of the error, a plural."""
    numbers = array_of(values)
    if not (np.abs(numbers) <= FARTHEST).all():
        raise HostError(f"{subject} are {brief(values)}; they must be numbers up to {FARTHEST:g} m.")
    return numbers
