"""A stop from a steady circle: its signals and measures."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hosts.driving.result import Result
from hosts.measures.braking import locked
from hosts.measures.wheels import at_wheels

STEADY_TIME = 1.0  # s before the onset, in which the circle is undisturbed
MIN_SPEED = 2.0  # m/s, below which the sideslip is not evaluated

COMPARED: Sequence[Mapping[str, Any]] = [
    {"name": name, "unit": unit, "neutral": neutral, "text": text}
    for (name, unit, neutral), text in (
        (
            ("yaw_rate.ratio", "1", 1.0),
            "yaw rate divided by the yaw rate that keeps the circle at the speed then, 1 s after the onset",
        ),
        (
            ("yaw_rate.change", "rad/s", 0.0),
            "yaw rate minus the yaw rate that keeps the circle at the speed then, 1 s after the onset, into the turn",
        ),
        (
            ("yaw_acceleration.largest", "rad/s2", 0.0),
            "largest change of the yaw rate in the first second, positive into the turn",
        ),
        (
            ("sideslip.change", "rad", 0.0),
            "sideslip minus the sideslip on the circle, 1 s after the onset, positive to the inside",
        ),
        (
            ("ay.ratio", "1", 1.0),
            "lateral acceleration divided by that of the circle at the speed then, 1 s after the onset",
        ),
        (("path.deviation", "m", 0.0), "distance from the circle 1 s after the onset, positive outside"),
    )
]
"""The values of `Stop.values` for the files of tests: name, unit, value on the circle, and description."""


@dataclass(frozen=True)
class Stop:
    """One stop from the circle, by the brake or with the throttle released."""

    pedal: float
    result: Result
    onset: float
    """Time of the first pedal motion, s; NaN if the car did not get onto the circle."""
    reason: str
    """Reason of the end of the run, see `StopConditions`."""

    @property
    def steady(self) -> NDArray[np.bool_]:
        """Whether a sample is of the undisturbed circle, shape (n,)."""
        t = self.result.time
        return np.asarray((t >= self.onset - STEADY_TIME - 1e-9) & (t <= self.onset + 1e-9))

    def at(self, name: str, after: float) -> float:
        """Value of an output at a time after the onset, s; NaN if the run ends before."""
        t, when = self.result.time, self.onset + after
        return float(np.interp(when, t, self.result.continuous(name))) if t[-1] >= when else math.nan

    def before(self, name: str) -> float:
        """Mean of an output on the undisturbed circle."""
        return float(self.result.continuous(name)[self.steady].mean())

    @property
    def circle(self) -> tuple[float, float, float]:
        """Centre and radius of the undisturbed circle, m."""
        return circle_through(self.result["chassis.x"][self.steady], self.result["chassis.y"][self.steady])

    @property
    def signed_radius(self) -> float:
        """Radius of the undisturbed circle, m; negative: to the right."""
        return math.copysign(self.circle[2], self.before("chassis.wz"))

    @property
    def lateral_acceleration_on_circle(self) -> float:
        """Lateral acceleration on the undisturbed circle: speed squared over radius, m/s2."""
        return self.before("speed") ** 2 / self.circle[2]

    @property
    def deceleration(self) -> float:
        """Mean deceleration in the first second, m/s2."""
        return self.before("speed") - self.at("speed", 1.0)

    @property
    def lateral_acceleration(self) -> NDArray[np.float64]:
        """Lateral acceleration to the left, m/s2, shape (n,); speed times yaw rate if the car has no such output."""
        r = self.result
        return r["chassis.ay"] if "chassis.ay" in r else r["speed"] * r["chassis.wz"]

    def values(self) -> dict[str, float]:
        """The values of `COMPARED` 1 s after the onset; empty if the car is slow or the run has ended by then."""
        speed = self.at("speed", 1.0)
        if math.isnan(speed) or speed < MIN_SPEED:
            return {}
        t, reference = self.result.time, float(yaw_rate_on_circle(np.array([speed]), self.signed_radius)[0])
        first = (t >= self.onset) & (t <= self.onset + 1.0)
        change = np.gradient(self.result["chassis.wz"], t)[first] if first.sum() > 2 else np.full(1, math.nan)
        yaw_rate = self.at("chassis.wz", 1.0)
        side = math.copysign(1.0, self.signed_radius)
        ay = float(np.interp(self.onset + 1.0, t, self.lateral_acceleration))
        x, y = (np.array([self.at(n, 1.0)]) for n in ("chassis.x", "chassis.y"))
        # Positive to the inside of the turn, so that left and right turns are comparable.
        return {
            "yaw_rate.ratio": yaw_rate / reference,
            "yaw_rate.change": side * (yaw_rate - reference),
            "yaw_acceleration.largest": float(side * change[np.argmax(np.abs(change))]),
            "sideslip.change": side * (self.at("sideslip", 1.0) - self.before("sideslip")),
            "ay.ratio": ay * self.signed_radius / speed**2,
            "path.deviation": float(distance_from_circle(x, y, self.circle)[0]),
        }

    @property
    def shown(self) -> NDArray[np.bool_]:
        """Whether a sample is drawn: at most `STEADY_TIME` before the onset; shape (n,)."""
        return np.asarray(self.result.time >= self.onset - STEADY_TIME)

    def over_time(self, name: str) -> NDArray[np.float64]:
        """An output at the samples that are drawn; NaN of a sideslip below the speed `MIN_SPEED`."""
        values = self.result[name][self.shown]
        return (
            np.where(self.result["speed"][self.shown] > MIN_SPEED, values, math.nan) if name == "sideslip" else values
        )

    @property
    def locks(self) -> bool | None:
        """Whether a wheel locks; None if the car does not provide slips."""
        slip = at_wheels(self.result, "slip")
        if slip is None:
            return None
        return bool(locked(slip, self.result["speed"])[self.result.time > self.onset].any())


def circle_through(x: NDArray[np.float64], y: NDArray[np.float64]) -> tuple[float, float, float]:
    """Least-squares circle through points, after Kåsa. `x`, `y`: m, shape (n,).

    Returns `centre_x`, `centre_y` and `radius`, m.
    """
    # Relative to the mean, which reduces rounding errors.
    mx, my = float(x.mean()), float(y.mean())
    u, v = x - mx, y - my
    (cu, cv, c), *_ = np.linalg.lstsq(np.column_stack([2.0 * u, 2.0 * v, np.ones(len(u))]), u**2 + v**2, rcond=None)
    return float(mx + cu), float(my + cv), float(np.sqrt(c + cu**2 + cv**2))


def distance_from_circle(
    x: NDArray[np.float64], y: NDArray[np.float64], circle: tuple[float, float, float]
) -> NDArray[np.float64]:
    """Distance of points from a circle, m, positive outside, shape (n,). `circle`: result of `circle_through`."""
    return np.asarray(np.hypot(x - circle[0], y - circle[1]) - circle[2])


def yaw_rate_on_circle(speed: NDArray[np.float64], radius: float) -> NDArray[np.float64]:
    """Yaw rate of a car on a circle, rad/s, shape (n,). `speed`: m/s, shape (n,); `radius`: m; negative: right turn."""
    return np.asarray(speed / radius)
