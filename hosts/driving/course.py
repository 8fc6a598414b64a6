"""A course of gates on the ground, and the path a driver follows through it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hosts.common.errors import HostError

# How far the path's curves reach into the lanes, m: it widens the bends and uses little of the room beside the car.
EASE = 5.0


@dataclass(frozen=True)
class Gate:
    """A lane with straight edges along x.

    Parameters
    ----------
    x_start, x_end, y_right, y_left : float
        Earth axes, m.
    """

    x_start: float
    x_end: float
    y_right: float
    y_left: float

    @property
    def centre(self) -> float:
        """Middle of the lane, m."""
        return 0.5 * (self.y_right + self.y_left)


@dataclass(frozen=True)
class Course:
    """Gates in the order they are passed."""

    name: str
    gates: tuple[Gate, ...]

    def path(self, x: float) -> tuple[float, float, float]:
        """The path at x: lane centres, joined by quintics that begin and end within the lanes.

        Parameters
        ----------
        x : float
            m.

        Returns
        -------
        y, slope, curvature : float
            m, dy/dx, 1/m (positive to the left).
        """
        y, slope, bend = self.gates[0].centre, 0.0, 0.0
        for before, after in zip(self.gates, self.gates[1:], strict=False):
            begin, length = before.x_end - EASE, after.x_start - before.x_end + 2.0 * EASE
            s = min(max((x - begin) / length, 0.0), 1.0)
            rise = after.centre - before.centre
            y += rise * s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
            slope += rise / length * 30.0 * s**2 * (1.0 - s) ** 2
            bend += rise / length**2 * 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s)
        return y, slope, bend / (1.0 + slope**2) ** 1.5

    def corners_outside(
        self, x: NDArray[np.float64], y: NDArray[np.float64], yaw: NDArray[np.float64], length: float, width: float
    ) -> float:
        """How far a rectangle driven along a path leaves the gates at most.

        Parameters
        ----------
        x, y, yaw : ndarray of shape (n,)
            Centre of the rectangle and heading, m and rad.
        length, width : float
            m.

        Returns
        -------
        float
            m; zero or less: it stays inside, by that margin.
        """
        worst = -np.inf
        for a in (-0.5 * length, 0.5 * length):
            for b in (-0.5 * width, 0.5 * width):
                cx = x + a * np.cos(yaw) - b * np.sin(yaw)
                cy = y + a * np.sin(yaw) + b * np.cos(yaw)
                for gate in self.gates:
                    inside = (cx >= gate.x_start) & (cx <= gate.x_end)
                    if inside.any():
                        out = np.maximum(cy[inside] - gate.y_left, gate.y_right - cy[inside])
                        worst = max(worst, float(out.max()))
        return worst


def iso_3888_1(vehicle_width: float, x_start: float = 15.0) -> Course:
    """Double lane change of ISO 3888-1: sections of 15, 30, 25, 25, 15 and 15 m, lanes 3.5 m apart.

    Parameters
    ----------
    vehicle_width : float
        Without mirrors, m; the lanes are 1.1, 1.2 and 1.3 times as wide, and 0.25 m.
    x_start : float
        Where the first lane begins, m.

    Returns
    -------
    Course
        The centres of the first and the second lane are taken 3.5 m apart.
    """
    offset = 3.5
    ends = x_start + np.cumsum([0.0, 15.0, 30.0, 25.0, 25.0, 30.0])
    lanes = ((0, 1.1, 0.0), (2, 1.2, offset), (4, 1.3, 0.0))
    gates = []
    for section, factor, centre in lanes:
        half = 0.5 * (factor * vehicle_width + 0.25)
        gates.append(Gate(float(ends[section]), float(ends[section + 1]), centre - half, centre + half))
    return Course("ISO 3888-1", tuple(gates))


def iso_3888_2(vehicle_width: float, x_start: float = 15.0) -> Course:
    """Obstacle avoidance of ISO 3888-2: sections of 12, 13.5, 11, 12.5 and 12 m, 61 m in all.

    Parameters
    ----------
    vehicle_width : float
        Without mirrors, m; the lanes are 1.1 times as wide and 0.25 m, 1 m wider, and 1.3 times as wide and 0.25 m but
        at least 3 m.
    x_start : float
        Where the first lane begins, m.

    Returns
    -------
    Course
        The second lane begins 1 m to the left of the first one; the right edges of the first and the last lane are in
        one line. From public summaries of the standard, not from its text.
    """
    ends = x_start + np.cumsum([0.0, 12.0, 13.5, 11.0, 12.5, 12.0])
    first = 1.1 * vehicle_width + 0.25
    right, left = -0.5 * first, 0.5 * first
    beside = left + 1.0
    lanes = (
        (0, right, left),
        (2, beside, beside + vehicle_width + 1.0),
        (4, right, right + max(1.3 * vehicle_width + 0.25, 3.0)),
    )
    gates = [Gate(float(ends[k]), float(ends[k + 1]), y_right, y_left) for k, y_right, y_left in lanes]
    return Course("ISO 3888-2", tuple(gates))


COURSES = {"iso_3888_1": iso_3888_1, "iso_3888_2": iso_3888_2}


def course_of(name: str, vehicle_width: float) -> Course:
    """The course of a name; `HostError` if there is none."""
    if name not in COURSES:
        raise HostError(f"There is no course '{name}'; known are: {', '.join(COURSES)}.")
    return COURSES[name](vehicle_width)
