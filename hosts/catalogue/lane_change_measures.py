"""Measures and plots of passages of a course of cones."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hosts.catalogue.record import Line, Plot
from hosts.common.angles import angle_difference
from hosts.common.wheels import WHEELS
from hosts.driving.course import Course
from hosts.driving.result import Result
from hosts.measures.clearance import clearance, outline
from hosts.measures.measure import Measure
from hosts.measures.wheels import at_wheels, duration, lifted_wheels


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
        if self.result.failed_steps:
            return f"the FMU refused the step at {self.result.time[-1]:.4g} s"
        return self.not_driven and f"the car does not come through: {self.not_driven}"

    def at(self, quantity: str, x: float) -> float:
        """Value of an output when the car's front is at a place of the course; NaN if it is not there."""
        front = self.place[0] + 0.5 * self.size[0]
        there = np.flatnonzero(front >= x)
        return float(self.result[quantity][self.after][there[0]]) if len(there) else math.nan


_LARGEST = (
    ("ay.largest", "chassis.ay", "m/s2", "largest lateral acceleration"),
    ("steering_wheel_angle.largest", "steering_wheel_angle", "rad", "largest angle of the steering wheel"),
    ("yaw_rate.largest", "chassis.wz", "rad/s", "largest yaw rate"),
    ("sideslip.largest", "sideslip", "rad", "largest sideslip"),
    ("roll.largest", "chassis.roll", "rad", "largest roll"),
)


def measures_of(name: str, passed: Passage | None, failed: Passage | None, resolution: float) -> list[Measure]:
    """Measures of a course.

    `name`: before the names of the measures; `passed`, `failed`: the fastest without and the slowest with a cone;
    `resolution`: of the limit, km/h.
    """
    none = "" if passed is not None else "no speed was passed"
    fastest = passed.wanted / 3.6 if passed is not None else math.nan
    slowest = failed.wanted / 3.6 if failed is not None else math.nan
    note = none
    if passed is not None:
        limited = f"to within {resolution:g} km/h" if failed is not None else "nothing was hit"
        note = f"{limited}; driver: {passed.driver}"
    made = [
        Measure(f"{name}.speed", fastest, "m/s", "highest speed of the driver at which no cone is hit", note=note),
        Measure(
            f"{name}.speed_hit",
            slowest,
            "m/s",
            "lowest speed at which a cone is hit",
            note="" if failed is not None else "none up to the highest speed",
        ),
    ]
    entry = exit_speed = least = math.nan
    if passed is not None:
        first, last = passed.course.gates[0], passed.course.gates[-1]
        entry = passed.at("speed", first.x_start + (passed.release if math.isfinite(passed.release) else 0.0))
        exit_speed = passed.at("speed", last.x_end)
        least = passed.least_clearance
    made += [
        Measure(f"{name}.entry_speed", entry, "m/s", "speed of the car with its front in the first lane", note=none),
        Measure(
            f"{name}.exit_speed",
            exit_speed,
            "m/s",
            "speed of the car with its front at the end of the last lane",
            note=none,
        ),
        Measure(f"{name}.clearance", least, "m", "least distance of the car's outline from the cones", note=none),
    ]
    for measure, output, unit, text in _LARGEST:
        value, why = math.nan, none
        if passed is not None:
            why = "" if output in passed.result else f"the car does not tell {output}"
            value = math.nan if why else float(np.abs(passed.result[output][passed.after]).max())
        made.append(Measure(f"{name}.{measure}", value, unit, text, note=why))
    return [replace(m, text=f"{_title(name)}: {m.text}") for m in made + _loads(name, passed, none)]


def _loads(name: str, passed: Passage | None, none: str) -> list[Measure]:
    least = lifted = math.nan
    why, which = none, ""
    if passed is not None:
        loads = at_wheels(passed.result, "Fz")
        why = "" if loads is not None else "the car does not tell wheel_FL.Fz and its like"
        if loads is not None:
            shown = loads[passed.after]
            off = lifted_wheels(shown)
            least = float((shown / loads[0]).min())
            lifted = max(duration(passed.result.time[passed.after], off[:, k]) for k in range(4))
            which = ", ".join(wheel for k, wheel in enumerate(WHEELS) if np.any(off[:, k]))
    return [
        Measure(f"{name}.load.least", least, "1", "least load of a wheel over that at the start", note=why),
        Measure(f"{name}.load.lifted_time", lifted, "s", "longest time of a wheel off the road", note=why or which),
    ]


def _title(name: str) -> str:
    return name.upper().replace("_", " ", 1).replace("_", "-")


def plots_of(name: str, passed: Passage | None, failed: Passage | None) -> list[Plot]:
    """Path with the outline, and signals over the way, of the fastest clean passage and of the slowest other one."""
    title = _title(name)
    shown = [(p, word) for p, word in ((passed, "passed"), (failed, "failed")) if p is not None and p.after.any()]
    if not shown:
        return []
    plots = []
    for passage, word in shown:
        lines = [_lanes(passage.course), _outlines(passage), Line("path", *passage.place[:2])]
        plots.append(Plot(f"{title}, {word}: path", "x, m", "y, m", lines))
    best = shown[0][0]
    for output, y in (
        ("chassis.ay", "lateral acceleration, m/s²"),
        ("steering_wheel_angle", "steering wheel angle, rad"),
        ("chassis.wz", "yaw rate, rad/s"),
        ("speed", "speed, m/s"),
    ):
        if output in best.result:
            line = Line("", best.place[0], best.result[output][best.after])
            plots.append(Plot(f"{title}: {y.split(',')[0]}", "x, m", y, [line]))
    return plots


def _lanes(course: Course) -> Line:
    points = []
    for gate in course.gates:
        for edge in (gate.y_left, gate.y_right):
            points += [(gate.x_start, edge), (gate.x_end, edge), (math.nan, math.nan)]
    return Line("lanes", *np.array(points).T)


def _outlines(passage: Passage) -> Line:
    """The car every three metres."""
    x, y, yaw = passage.place
    way = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    picked = np.unique(np.searchsorted(way, np.arange(0.0, way[-1], 3.0)))
    corners = outline(x[picked], y[picked], yaw[picked], *passage.size)
    gap = np.full((len(picked), 1, 2), math.nan)
    points = np.concatenate([corners, corners[:, :1], gap], axis=1).reshape(-1, 2)
    return Line("outline", points[:, 0], points[:, 1])
