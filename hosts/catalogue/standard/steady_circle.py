"""Steady driving on a circle, both ways, after ISO 4138: what a car needs of steering as it is driven faster."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from hosts.catalogue.car import TestedCar
from hosts.catalogue.circle_run import CONSTANT_ANGLE, CONSTANT_RADIUS, CONSTANT_SPEED, CircleRun, drive_circle
from hosts.catalogue.definition import load_test
from hosts.catalogue.record import Line, Plot, TestRecord
from hosts.catalogue.steering_ratio import RATIO, WHEELS, steering_ratio
from hosts.driving.pilots.circle_follower import SENSES
from hosts.measures.gradient import Gradient, gradient
from hosts.measures.measure import Measure

_SIDES = {"left": 1.0, "right": -1.0}
_POINTS = 400
_Signal: TypeAlias = Callable[[CircleRun], NDArray[np.float64]]
_WHEELBASE = "vehicle.wheelbase"


def why_not(car: TestedCar, settings: Mapping[str, float]) -> str | None:
    """See `StandardTest`."""
    if settings["method"] not in (CONSTANT_RADIUS, CONSTANT_ANGLE, CONSTANT_SPEED):
        return f"The setting method of steady_circle is {settings['method']:g}; it must be 1, 2 or 3."
    if settings["fit_to"] < settings["fit_from"] + 0.5:
        return (
            f"The regression of steady_circle is to go from {settings['fit_from']:g} to {settings['fit_to']:g} m/s2; "
            "fit_to must be at least 0.5 m/s2 above fit_from."
        )
    missing = [name for name in SENSES if name not in car.outputs]
    if settings["method"] == CONSTANT_RADIUS and missing:
        return (
            f"To hold a circle needs the outputs {', '.join(missing)}, which {car.path.name} does not have; "
            f"--test-setting steady_circle.method=2 does without."
        )
    if settings["method"] != CONSTANT_SPEED and not {RATIO, *WHEELS} & {*car.constants, *car.outputs}:
        return (
            f"To drive a circle needs the constant {RATIO} or the angles of the front wheels, which "
            f"{car.path.name} does not tell; an alias file can give it (--aliases)."
        )
    return None


def perform(car: TestedCar, settings: Mapping[str, float], progress: Callable[[float], None]) -> TestRecord:
    """See `StandardTest`."""
    ratio = steering_ratio(car)
    progress(0.04)
    runs: dict[str, CircleRun] = {}
    for k, (side, sign) in enumerate(_SIDES.items()):
        runs[side] = drive_circle(car, sign, settings, ratio, part_of(progress, k))
    notes = [f"To the {side} {run.end}" for side, run in runs.items() if run.end]
    notes += [runs["left"].steering_note] if runs["left"].steering_note else []
    measures = _measures(car.constants[_WHEELBASE], ratio, runs, settings)
    return TestRecord(measures, _plots(runs), {side: run.result for side, run in runs.items()}, notes)


def part_of(progress: Callable[[float], None], run: int) -> Callable[[float], None]:
    """The progress of one of two runs."""
    return lambda part: progress(0.04 + 0.48 * (run + part))


def _measures(
    wheelbase: float, ratio: float, runs: Mapping[str, CircleRun], settings: Mapping[str, float]
) -> list[Measure]:
    low, high = settings["fit_from"], settings["fit_to"]
    over = f"over the lateral acceleration, {low:g} to {high:g} m/s²"
    short = {
        side: f"To the {side} the car reached {run.largest:.3g} m/s² of the {high:g} m/s² of the regression."
        for side, run in runs.items()
        if not run.largest >= high
    }

    def fit(values: _Signal) -> dict[str, Gradient]:
        return {
            side: gradient(_SIDES[side] * run.acceleration, _SIDES[side] * values(run), low, high)
            for side, run in runs.items()
        }

    def mean(fits: Mapping[str, Gradient]) -> float:
        return float(np.mean([f.slope for f in fits.values()]))

    def ackermann(run: CircleRun) -> NDArray[np.float64]:
        return np.asarray(wheelbase * run.acceleration / np.maximum(run.speed, 0.1) ** 2)

    steering = fit(lambda run: run.steering)
    understeer = fit(lambda run: run.steering / ratio - ackermann(run))
    missing = " ".join(short.values())
    unknown = missing or ("" if math.isfinite(ratio) else f"The car does not tell its constant {RATIO}.")
    k = mean(understeer)
    left, right = (understeer[side].slope for side in _SIDES)
    text = "understeer gradient, slope of the steering-wheel angle over the ratio less wheelbase over radius"
    made = [
        Measure("understeer_gradient", k, "rad.s2/m", f"{text} {over}; mean of both sides", None, unknown),
        Measure(
            "understeer_gradient.left", left, "rad.s2/m", "understeer gradient in turns to the left", None, unknown
        ),
        Measure(
            "understeer_gradient.right", right, "rad.s2/m", "understeer gradient in turns to the right", None, unknown
        ),
        Measure(
            "understeer_gradient.difference",
            left - right,
            "rad.s2/m",
            "understeer gradient to the left less that to the right",
            None,
            unknown,
        ),
        Measure("steering_ratio", ratio, "1", "steering-wheel angle over the mean angle of the front wheels, by 3 m/s"),
        _speed("characteristic_speed", k, wheelbase, unknown),
        _speed("critical_speed", -k, wheelbase, unknown),
        Measure(
            "steering_gradient",
            mean(steering),
            "rad.s2/m",
            f"gradient of the steering-wheel angle {over}",
            None,
            missing,
        ),
    ]
    others: tuple[tuple[str, str, _Signal], ...] = (
        ("sideslip_gradient", "of the sideslip angle at the reference point", lambda run: run.sideslip),
        ("roll_gradient", "of the roll angle", lambda run: run.roll),
        ("steering_torque_gradient", "of the torque of the hands", lambda run: run.torque),
    )
    for name, what, values in others:
        unit = "N.s2" if name.startswith("steering") else "rad.s2/m"
        there = all(np.isfinite(values(run)).any() for run in runs.values())
        why = missing if there else "The car has no such output."
        made.append(Measure(name, mean(fit(values)), unit, f"gradient {what} {over}", None, why))
    for side, run in runs.items():
        words = f"largest lateral acceleration to the {side}, mean over 1 s"
        made.append(Measure(f"lateral_acceleration_max.{side}", run.largest, "m/s2", words, None, run.end))
    return made


def _speed(name: str, gradient_of: float, wheelbase: float, note: str) -> Measure:
    """Characteristic speed of a car that understeers, critical speed of one that oversteers."""
    kind = "understeer" if name.startswith("characteristic") else "oversteer"
    text = f"{name.replace('_', ' ')}, root of wheelbase over {kind} gradient"
    if not math.isfinite(gradient_of):
        return Measure(name, math.nan, "m/s", text, None, note)
    if gradient_of <= 0.0:
        return Measure(name, math.nan, "m/s", text, None, f"The car does not {kind} there.", exists=False)
    return Measure(name, math.sqrt(wheelbase / gradient_of), "m/s", text)


def _plots(runs: Mapping[str, CircleRun]) -> list[Plot]:
    made = []
    signals: tuple[tuple[str, str, float, _Signal], ...] = (
        ("Steering on the circle", "steering-wheel angle, °", math.degrees(1.0), lambda run: run.steering),
        ("Sideslip on the circle", "sideslip angle, °", math.degrees(1.0), lambda run: run.sideslip),
        ("Roll on the circle", "roll angle, °", math.degrees(1.0), lambda run: run.roll),
        ("Torque of the hands on the circle", "steering-wheel torque, N m", 1.0, lambda run: run.torque),
        ("Speed on the circle", "speed, km/h", 3.6, lambda run: run.speed),
    )
    for title, y, factor, values in signals:
        lines = []
        for side, run in runs.items():
            if np.isfinite(values(run)).any():
                rows = np.unique(np.linspace(0, len(run.time) - 1, _POINTS).astype(int))
                lines.append(Line(side, run.acceleration[rows], factor * values(run)[rows]))
        if lines:
            made.append(Plot(title, "lateral acceleration, m/s²", y, lines))
    return made


TEST = load_test("steady_circle", perform, why_not)
