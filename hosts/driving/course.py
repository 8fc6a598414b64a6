"""A course of gates on the ground, and the path a driver follows through it."""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ali3.iso_3888 import Gate, Track, lanes
from ali3.near_names import did_you_mean
from hosts.common.errors import HostError

TRACKS: dict[str, Track] = {"iso_3888_1": "ISO 3888-1", "iso_3888_2": "ISO 3888-2"}
"""Tracks by their names in manoeuvres."""
EASE = 5.0
"""Length by which curves of the path extend into the lanes, m: bends are wider, at little cost in lateral space."""
ROWS = 1.0
"""Largest distance of rows for a verdict on lanes, m; in a bend of 20 m its chord deviates by 6 mm."""


@dataclass(frozen=True)
class Course:
    """A course of gates in the order in which they are passed."""

    name: str
    gates: tuple[Gate, ...]

    def path(self, x: float) -> tuple[float, float, float]:
        """The path at x: lane centres, joined by quintics that begin and end within the lanes. `x`: in m.

        Returns `y`, `slope` and `curvature`: in m, dy/dx, 1/m (positive to the left).
        """
        y, slope, bend = self.gates[0].centre, 0.0, 0.0
        for begin, length, rise in self._changes:
            if x <= begin:
                break
            if x >= begin + length:
                y += rise
                continue
            s = (x - begin) / length
            y += rise * s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
            slope += rise / length * 30.0 * s**2 * (1.0 - s) ** 2
            bend += rise / length**2 * 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s)
        return y, slope, bend / (1.0 + slope**2) ** 1.5

    @cached_property
    def _changes(self) -> list[tuple[float, float, float]]:
        """Begin, length and lateral offset (positive to the left) of each quintic, m."""
        return [
            (before.x_end - EASE, after.x_start - before.x_end + 2.0 * EASE, after.centre - before.centre)
            for before, after in pairwise(self.gates)
        ]

    def not_driven(self, x: NDArray[np.float64], length: float) -> str:
        """A clause on the first lane that a vehicle has not driven; empty if it has driven all.

        `x`: centre of the vehicle, m, shape (n,); `length`: of the vehicle, m. It must begin before the first lane,
        reach each lane, and end behind the last one, with rows close enough in between.
        """
        if not len(x):
            return "no lane was driven"
        front, rear = x + 0.5 * length, x - 0.5 * length
        begin, end = self.gates[0].x_start, self.gates[-1].x_end
        if front[0] > begin:
            return f"lane 1 was not driven from its beginning at {begin:.4g} m: the front starts at {front[0]:.4g} m"
        for number, gate in enumerate(self.gates, start=1):
            if front.max() < gate.x_start:
                detail = f"it begins at {gate.x_start:.4g} m, the front comes to {front.max():.4g} m"
                return f"lane {number} was not reached: {detail}"
        if rear[-1] <= end:
            detail = f"it ends at {end:.4g} m, the rear is at {rear[-1]:.4g} m at last"
            return f"lane {len(self.gates)} was not left: {detail}"
        spacing = float(np.abs(np.diff(x)).max(initial=0.0, where=(front[1:] >= begin) & (rear[:-1] <= end)))
        return f"rows are {spacing:.3g} m apart, lanes are seen by {ROWS:g} m or less" if spacing > ROWS else ""

    def corners_outside(
        self, x: NDArray[np.float64], y: NDArray[np.float64], yaw: NDArray[np.float64], length: float, width: float
    ) -> float:
        """The largest distance of a rectangle driven along a path outside of the gates, m; negative: a margin inside.

        `x`, `y`, `yaw`: centre of the rectangle and heading, m and rad, shape (n,); `length`, `width`: m.
        """
        largest = -np.inf
        for along in (-0.5 * length, 0.5 * length):
            for across in (-0.5 * width, 0.5 * width):
                cx = x + along * np.cos(yaw) - across * np.sin(yaw)
                cy = y + along * np.sin(yaw) + across * np.cos(yaw)
                for gate in self.gates:
                    inside = (cx >= gate.x_start) & (cx <= gate.x_end)
                    if inside.any():
                        excess = np.maximum(cy[inside] - gate.y_left, gate.y_right - cy[inside])
                        largest = max(largest, float(excess.max()))
        return largest


def course_of(name: str, vehicle_width: float, x_start: float = 15.0) -> Course:
    """The course of a name.

    `name`: one of `TRACKS`; `vehicle_width`: without mirrors, m; `x_start`: of the first lane, m. Raises `HostError` if
    there is no such course.
    """
    if name not in TRACKS:
        near = did_you_mean(name, TRACKS, f"known are: {', '.join(TRACKS)}")
        raise HostError(f"There is no course '{name}'{near}")
    return Course(TRACKS[name], lanes(TRACKS[name], vehicle_width, x_start))
