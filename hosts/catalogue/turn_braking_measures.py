"""Measures and plots of stops from one circle with growing deceleration."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hosts.catalogue.record import Line, Plot
from hosts.driving.result import Result
from hosts.measures.braking import locked
from hosts.measures.measure import Measure
from hosts.measures.turning import circle_through, off_circle, yaw_rate_on_circle
from hosts.measures.wheels import at_wheels

STEADY = 1.0  # s before the onset, over which the circle is taken
SLOWEST = 2.0  # m/s; slower, angles of travel mean little
QUANTITIES = (
    ("yaw_rate.ratio", "1", "yaw rate over that which keeps the circle at the speed then, 1 s after the onset"),
    (
        "yaw_rate.change",
        "rad/s",
        "yaw rate less that which keeps the circle at the speed then, 1 s after the onset, into the turn",
    ),
    (
        "yaw_acceleration.largest",
        "rad/s2",
        "largest change of the yaw rate in the first second, positive into the turn",
    ),
    ("sideslip.change", "rad", "sideslip less that on the circle, 1 s after the onset, positive to the inside"),
    ("ay.ratio", "1", "lateral acceleration over that of the circle at the speed then, 1 s after the onset"),
    ("path.deviation", "m", "distance from the circle 1 s after the onset, positive outside"),
)


@dataclass(frozen=True)
class Stop:
    """One stop from the circle."""

    pedal: float
    result: Result
    onset: float
    """First movement of the pedal, s; NaN if the car did not get there."""
    reason: str
    """Why the run ended."""

    @property
    def steady(self) -> NDArray[np.bool_]:
        """Samples of the undisturbed circle, of shape (n,)."""
        t = self.result.time
        return np.asarray((t >= self.onset - STEADY - 1e-9) & (t <= self.onset + 1e-9))

    def at(self, name: str, after: float) -> float:
        """Value of an output a time after the onset; NaN if the run does not last so long."""
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
        """m; negative: to the right."""
        return math.copysign(self.circle[2], self.before("chassis.wz"))

    @property
    def deceleration(self) -> float:
        """Mean over the first second, m/s2."""
        return self.before("speed") - self.at("speed", 1.0)

    @property
    def lateral_acceleration(self) -> NDArray[np.float64]:
        """Towards the left, m/s2; speed times yaw rate where the car does not tell it."""
        r = self.result
        return r["chassis.ay"] if "chassis.ay" in r else r["speed"] * r["chassis.wz"]

    def values(self) -> dict[str, float]:
        """Those of `QUANTITIES`; NaN where the car stands or the run is over before."""
        speed = self.at("speed", 1.0)
        if math.isnan(speed) or speed < SLOWEST:
            return {name: math.nan for name, _, _ in QUANTITIES}
        t, wanted = self.result.time, float(yaw_rate_on_circle(np.array([speed]), self.signed_radius)[0])
        first = (t >= self.onset) & (t <= self.onset + 1.0)
        change = np.gradient(self.result["chassis.wz"], t)[first] if first.sum() > 2 else np.full(1, math.nan)
        yaw_rate = self.at("chassis.wz", 1.0)
        side = math.copysign(1.0, self.signed_radius)
        ay = float(np.interp(self.onset + 1.0, t, self.lateral_acceleration))
        x, y = (np.array([self.at(n, 1.0)]) for n in ("chassis.x", "chassis.y"))
        # towards the inside of the turn positive, so that left and right turns read alike
        return {
            "yaw_rate.ratio": yaw_rate / wanted,
            "yaw_rate.change": side * (yaw_rate - wanted),
            "yaw_acceleration.largest": float(side * change[np.argmax(np.abs(change))]),
            "sideslip.change": side * (self.at("sideslip", 1.0) - self.before("sideslip")),
            "ay.ratio": ay * self.signed_radius / speed**2,
            "path.deviation": float(off_circle(x, y, self.circle)[0]),
        }

    @property
    def locks(self) -> bool | None:
        """Whether a wheel locks; None where the car does not tell slips."""
        slip = at_wheels(self.result, "slip")
        if slip is None:
            return None
        return bool(locked(slip, self.result["speed"])[self.result.time > self.onset].any())


def measures_of(stops: Sequence[Stop], settings: Mapping[str, float]) -> list[Measure]:
    """Measures over all stops.

    `stops`: with growing pedal; `settings`: ``deceleration``, m/s2, at which quantities are compared.
    """
    braked = [s for s in stops if not math.isnan(s.onset)]
    none = "" if braked else "the car did not get onto the circle"
    made = _steady(braked[0] if braked else None, none)
    rows = [(s, s.deceleration, s.values()) for s in braked]
    known = sorted((d, v) for _, d, v in ((s, d, tuple(v.values())) for s, d, v in rows) if not math.isnan(d + sum(v)))
    decelerations = np.array([d for d, _ in known])
    at, note = settings["deceleration"], none
    reached = len(known) > 0 and decelerations[0] <= at <= decelerations[-1]
    if not none and not reached:
        span = f"{decelerations[0]:.3g} to {decelerations[-1]:.3g} m/s2" if len(known) else "none"
        note = f"the stops that last a second reach mean decelerations of {span}; choose one of these"
    for k, (name, unit, text) in enumerate(QUANTITIES):
        column = np.array([v[k] for _, v in known])
        value = float(np.interp(at, decelerations, column)) if reached else math.nan
        worst_text = f"{text}; at the stop where it differs most"
        text = f"{text}; at {at:g} m/s2 of mean deceleration in that second"
        made.append(Measure(name, value, unit, text, note=note))
        neutral = 1.0 if name.endswith("ratio") else 0.0
        worst = float(column[np.argmax(np.abs(column - neutral))]) if len(known) else math.nan
        why = "" if len(known) else (none or "no stop lasts a second")
        made.append(Measure(f"worst.{name}", worst, unit, worst_text, note=why))
    spun = [d for s, d, _ in rows if s.reason in ("spun", "rolled")]
    locking = [d for s, d, _ in rows if s.locks]
    untold = bool(braked) and braked[0].locks is None
    return [
        *made,
        Measure(
            "spin.deceleration",
            min(spun) if spun else math.nan,
            "m/s2",
            "least mean deceleration at which the car turned by more than 90 degrees against its travel, or rolled",
            note=none or ("" if spun else "it did not"),
            exists=bool(spun or none),
        ),
        Measure(
            "lock.deceleration",
            min(locking) if locking else math.nan,
            "m/s2",
            "least mean deceleration at which a wheel locked",
            note=none
            or ("the car does not tell the slip of its wheels" if untold else "" if locking else "none locked"),
            exists=bool(locking or untold or none),
        ),
        Measure(
            "deceleration.largest",
            max((d for _, d, _ in rows if not math.isnan(d)), default=math.nan),
            "m/s2",
            "largest mean deceleration of the first second",
            note=none,
        ),
    ]


def _steady(stop: Stop | None, none: str) -> list[Measure]:
    """The undisturbed circle."""
    names = (
        ("steady.radius", "m", "radius of the undisturbed circle"),
        ("steady.speed", "m/s", "speed on the undisturbed circle"),
        ("steady.ay", "m/s2", "lateral acceleration on the undisturbed circle, speed squared over radius"),
        ("steady.yaw_rate", "rad/s", "yaw rate on the undisturbed circle, positive to the left"),
        ("steady.sideslip", "rad", "sideslip on the undisturbed circle, positive to the left"),
    )
    values = [math.nan] * len(names)
    if stop is not None:
        radius, speed = stop.circle[2], stop.before("speed")
        values = [radius, speed, speed**2 / radius, stop.before("chassis.wz"), stop.before("sideslip")]
    return [Measure(n, x, unit, text, note=none) for (n, unit, text), x in zip(names, values, strict=True)]


def plots_of(stops: Sequence[Stop]) -> list[Plot]:
    """Quantities over the mean deceleration, and paths and signals of all stops over time."""
    braked = [s for s in stops if not math.isnan(s.onset)]
    if not braked:
        return []
    rows = sorted((s.deceleration, tuple(s.values().values())) for s in braked if not math.isnan(s.deceleration))
    x = np.array([d for d, _ in rows])
    plots = []
    for k, (name, unit, _) in enumerate(QUANTITIES):
        label = f"{name.replace('.', ' ').replace('_', ' ')} at 1 s{'' if unit == '1' else ', ' + unit}"
        line = Line("", x, np.array([v[k] for _, v in rows]))
        plots.append(Plot(f"Braking in a turn: {name}", "mean deceleration of the first second, m/s²", label, [line]))
    for name, label in (("chassis.wz", "yaw rate, rad/s"), ("sideslip", "sideslip, rad"), ("speed", "speed, m/s")):
        lines = [_over_time(s, name) for s in braked]
        plots.append(Plot(f"Braking in a turn: {label.split(',')[0]}", "time from the onset, s", label, lines))
    lines = []
    for s in braked:
        shown = s.result.time >= s.onset - STEADY
        lines.append(Line(_label(s), s.result["chassis.x"][shown], s.result["chassis.y"][shown]))
    plots.append(Plot("Braking in a turn: path", "x, m", "y, m", lines, equal=True))
    return plots


def _label(stop: Stop) -> str:
    return f"pedal {stop.pedal:.2g}"


def _over_time(stop: Stop, name: str) -> Line:
    shown = stop.result.time >= stop.onset - STEADY
    values = stop.result[name][shown]
    if name == "sideslip":
        values = np.where(stop.result["speed"][shown] > SLOWEST, values, math.nan)
    return Line(_label(stop), stop.result.time[shown] - stop.onset, values)
