"""Double lane change: the highest entry speed without hitting a cone, on both courses of ISO 3888."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hosts.catalogue.car import TestedCar
from hosts.catalogue.measure_sheet import Sheet
from hosts.catalogue.preparation import RunUp, StopConditions, constant_inputs
from hosts.common.angles import angle_difference
from hosts.common.errors import HostError
from hosts.driving.course import Course, course_of
from hosts.driving.pilots.course_follower import CourseFollower, DriverSettings
from hosts.driving.pilots.line_follower import LineFollower
from hosts.driving.pilots.pilot import Pilot
from hosts.driving.pilots.run_up_pilot import RunUpPilot
from hosts.driving.planned_course import planned
from hosts.driving.result import Result
from hosts.measures.clearance import clearance, outline

STEP = 0.005  # s, of the driver
RUN_UP = 10.0  # m, from the front of the car to the first lane
RELEASED_AFTER = 2.0  # m into the first lane of ISO 3888-2


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
        return (math.cos(yaw0) * dx + math.sin(yaw0) * dy, math.cos(yaw0) * dy - math.sin(yaw0) * dx, yaw)

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
        return self.not_driven and f"the car does not pass the course: {self.not_driven}"

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


@dataclass(frozen=True)
class _CourseSettings:
    """A course and its driver settings."""

    name: str
    release: float  # m into the first lane


_COURSES = (_CourseSettings("iso_3888_1", math.inf), _CourseSettings("iso_3888_2", RELEASED_AFTER))

DRIVERS: dict[str, tuple[float, float, float]] = {
    "least curvature, close": (0.2, 0.3, 0.3),
    "least curvature, early": (0.4, 0.5, 0.3),
    "least curvature, late": (0.3, 0.5, 0.5),
    "centre line": (0.25, 0.0, 0.0),
}
"""Drivers that try each speed: preview, horizon and lead of `LineFollower`, s."""


def drive(sheet: Sheet) -> None:
    """Drive each course at increasing speed until a cone is hit, then bisect the limit."""
    car, settings = sheet.with_step_up_to(STEP, "the steering of the driver"), sheet.settings
    sheet.add("driver", count=len(DRIVERS))
    courses = _COURSES if settings["course"] == 0.0 else (_COURSES[int(settings["course"]) - 1],)
    for k, course in enumerate(courses):

        def report(done: float, k: int = k) -> None:
            sheet.progress((k + done) / len(courses))

        passed, failed, notes = find_limit(car, course, settings, report)
        sheet.notes += notes
        add_limit(sheet, course.name, passed, failed)
        for word, passage in (("passed", passed), ("failed", failed)):
            if passage is not None:
                sheet.runs[f"{course.name}_{word}"] = passage.result


def add_limit(sheet: Sheet, name: str, passed: Passage | None, failed: Passage | None) -> None:
    """Add the measures of a course. `passed`, `failed`: the fastest clean passage and the slowest other one."""
    names = {"name": name, "title": name.upper().replace("_", " ", 1).replace("_", "-")}
    sheet.add("limit", fastest=passed, slowest=failed, **names)
    error = HostError("no speed was passed")
    sheet.add("fastest", passed=error if passed is None else passed, **names)
    passages = {word: p for word, p in (("passed", passed), ("failed", failed)) if p is not None and p.after.any()}
    for word, passage in passages.items():
        sheet.add("path", passage=passage, word=word, **names)
    if passages:
        sheet.add("signals", best=next(iter(passages.values())), **names)


def find_limit(
    car: TestedCar, layout: _CourseSettings, settings: Mapping[str, float], progress: Callable[[float], None]
) -> tuple[Passage | None, Passage | None, tuple[str, ...]]:
    """Find the fastest clean passage and the slowest other one, None if there is none, and notes."""
    passed: Passage | None = None
    failed: Passage | None = None
    speed, attempts = settings["lowest"], 0
    bisections = math.ceil(math.log2(max(settings["increment"] / settings["resolution"], 1.0)))
    most_attempts = math.ceil((settings["highest"] - settings["lowest"]) / settings["increment"]) + 1 + bisections
    while failed is None:
        passage = try_drivers(car, layout, speed, passed)
        attempts += 1
        progress(attempts / most_attempts)
        if passage.is_clean:
            passed = passage
            if speed >= settings["highest"]:
                return passed, None, (f"{layout.name}: no cone was hit up to {speed:g} km/h; take a higher highest.",)
            speed = min(speed + settings["increment"], settings["highest"])
        else:
            failed = passage
    if passed is None:
        note = f"{layout.name}: already at {speed:g} km/h {failed.failure}; take a lower lowest, if slower helps."
        return None, failed, (note,)
    while failed.target_speed - passed.target_speed > settings["resolution"] * (1.0 + 1e-9):
        passage = try_drivers(car, layout, 0.5 * (passed.target_speed + failed.target_speed), passed)
        attempts += 1
        progress(min(attempts / most_attempts, 1.0))
        if passage.is_clean:
            passed = passage
        else:
            failed = passage
    note = f"{layout.name}: at {failed.target_speed:g} km/h {failed.failure} (driver: {failed.driver})."
    return passed, failed, (note,)


def try_drivers(car: TestedCar, layout: _CourseSettings, speed: float, passed: Passage | None) -> Passage:
    """Drive a course by several drivers, the last successful one first, until a passage is clean; otherwise the best
    one.

    `speed`: km/h; `passed`: the last clean passage.
    """
    order = sorted(DRIVERS, key=lambda name: passed is None or name != passed.driver)
    results = []
    for driver in order:
        results.append(drive_through(car, layout, speed, driver))
        if results[-1].is_clean:
            return results[-1]
    return max(
        results, key=lambda p: (not p.not_driven, -math.inf if math.isnan(p.least_clearance) else p.least_clearance)
    )


def pilot_of(driver: str, course: Course, constants: Mapping[str, float], speed: float) -> Pilot:
    """The pilot of a driver. `driver`: one of `DRIVERS`; `speed`: m/s."""
    wheelbase, largest_angle = constants["vehicle.wheelbase"], constants["vehicle.front_wheel_angle_max"]
    length, width = constants["vehicle.length"], constants["vehicle.width"]
    if driver == "centre line":
        return CourseFollower(course, DriverSettings(speed, wheelbase, largest_angle, length, width))
    preview, horizon, lead = DRIVERS[driver]
    return LineFollower(planned(course, 0.0, length, width), wheelbase, largest_angle, preview, horizon, lead)


def drive_through(car: TestedCar, layout: _CourseSettings, speed: float, driver: str) -> Passage:
    """Drive a course once. `speed`: km/h; `driver`: one of `DRIVERS`."""
    constants, entry_speed = car.facts.constants, speed / 3.6
    length, width = constants["vehicle.length"], constants["vehicle.width"]
    course = course_of(layout.name, width, RUN_UP + 0.5 * length)
    run_up = RunUp(car, entry_speed)
    pilot = RunUpPilot(
        pilot_of(driver, course, constants, entry_speed),
        entry_speed,
        run_up.is_over,
        course.gates[0].x_start + layout.release - 0.5 * length,
    )
    course_end = course.gates[-1].x_end + length
    conditions = StopConditions(stands=0.3 * entry_speed)

    def is_over(time: float, outputs: Mapping[str, float]) -> bool:
        if math.isnan(pilot.start):
            return time > run_up.longest
        x, y, _ = pilot.pose_on_course(outputs)
        return conditions(outputs) or x > course_end or abs(y) > 8.0

    stop_time = run_up.longest + 3.0 * course_end / entry_speed
    manoeuvre = constant_inputs(car, f"{layout.name} {speed:g} km/h", stop_time, {}, run_up.start)
    result = car.drive(manoeuvre, pilot, is_over)
    after = result.time >= pilot.start - 1e-9 if not math.isnan(pilot.start) else np.zeros(len(result.time), bool)
    return Passage(speed, result, driver, course, (length, width), pilot.pose, after, conditions.reason, layout.release)
