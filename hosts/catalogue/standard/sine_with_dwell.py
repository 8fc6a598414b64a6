"""Sine with dwell of growing amplitude, to both sides, after 49 CFR 571.126 (FMVSS 126) and ISO 19365."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np

from hosts.catalogue.car import TestedCar
from hosts.catalogue.definition import load_test
from hosts.catalogue.dwell_measures import EARLY, LATE, least_displacement, measures_of_dwell
from hosts.catalogue.dwell_series import DwellRun, amplitudes, processed, series
from hosts.catalogue.record import Line, Plot, TestRecord
from hosts.catalogue.steady_map import refuse_odd, why_not_reached
from hosts.catalogue.steered_run import Pedals, SteeredRun, steer
from hosts.catalogue.steering import SteeringInput
from hosts.common.errors import HostError
from hosts.driving.result import Result
from hosts.measures.slowly_increasing_steer import G, angle_by_regression

_RATE = math.radians(13.5)
_RAMP_TO = 0.5 * G
_MOST_RUNS = 80


def why_not(car: TestedCar, settings: Mapping[str, float]) -> str | None:
    """Why the test cannot be done with this car; None if it can."""
    return SteeringInput.of(car.facts).why_no_angles("sine_with_dwell")


def perform(car: TestedCar, settings: Mapping[str, float], progress: Callable[[float], None]) -> TestRecord:
    """See `StandardTest`."""
    given = SteeringInput.of(car.facts)
    speed = settings["speed"] / 3.6
    ramps = []
    for side in (1.0, -1.0):
        ramps.append(_ramp(car, speed, side, given.largest))
        progress(0.1 * len(ramps))
    refuse_odd(ramps[0])
    found = [angle_by_regression(r.steering, r.acceleration) if len(r.time) else math.nan for r in ramps]
    if not math.isfinite(sum(found)):
        raise HostError(_no_angle(ramps, settings["speed"]))
    # the regulation rounds to 0.1°, each ramp and the mean
    a = _rounded(0.5 * sum(map(_rounded, found)))
    wanted = amplitudes(a, settings["first"], settings["increment"], given.largest)
    if len(wanted) > _MOST_RUNS:
        raise HostError(
            f"A is {math.degrees(a):.1f}°, so the series to {math.degrees(wanted[-1]):.0f}° has {len(wanted)} runs "
            f"to each side, where {_MOST_RUNS} are the most: raise the setting increment, or look at the unit "
            "of the steering wheel's angle."
        )
    sides = [
        series(car, speed, side, wanted, lambda done, begin=begin: progress(begin + 0.4 * done))  # type: ignore[misc]
        for begin, side in ((0.2, 1.0), (0.6, -1.0))
    ]
    notes = _notes(sides, wanted, a, given)
    runs: dict[str, Result] = {"ramp_left": ramps[0].thinned(), "ramp_right": ramps[1].thinned()}
    for word, side_runs in zip(("left", "right"), sides, strict=True):
        runs |= {f"{word}_{math.degrees(r.amplitude):.0f}_deg": r.run.thinned() for r in side_runs}
    least = least_displacement(settings["gross_mass"])
    return TestRecord(measures_of_dwell(a, found, sides, wanted, least), _plots(ramps, sides, least), runs, notes)


TEST = load_test("sine_with_dwell", perform, why_not)


def _rounded(angle: float) -> float:
    return math.radians(round(math.degrees(angle), 1))


def _ramp(car: TestedCar, speed: float, side: float, largest: float) -> SteeredRun:
    """The slowly increasing steer to one side, filtered."""
    end = min(largest, math.radians(720.0))
    time, angle = np.array([0.0, end / _RATE]), side * np.array([0.0, end])
    name = f"slowly increasing steer {'left' if side > 0.0 else 'right'}"
    return processed(steer(car, name, speed, time, angle, Pedals.HOLD_SPEED, _RAMP_TO))


def _no_angle(ramps: list[SteeredRun], speed: float) -> str:
    for r in ramps:
        if not len(r.time):
            return why_not_reached(r.result, speed / 3.6)
    reached = min(float(np.abs(r.acceleration).max()) for r in ramps) / G
    return (
        f"The car reaches {reached:.2g} g at {speed:g} km/h while the steering wheel turns slowly; the angle A at "
        "0.3 g needs 0.375 g."
    )


def _notes(sides: list[list[DwellRun]], wanted: list[float], a: float, given: SteeringInput) -> list[str]:
    notes = [
        "The regulation is for cars with electronic stability control; where the model has none, a limit that is not "
        "kept is a statement about the car without it."
    ]
    for word, side in zip(("left", "right"), sides, strict=True):
        if side and side[-1].is_lost:
            how = (
                f"its sideslip angle came to {math.degrees(side[-1].measures.sideslip):.0f}°"
                if side[-1].run.whole
                else "the run ended early"
            )
            notes.append(
                f"Begun to the {word}, the car is lost at {math.degrees(side[-1].amplitude):.0f}° "
                f"({side[-1].amplitude / a:.2g} A; {how}); larger amplitudes, up to "
                f"{math.degrees(wanted[-1]):.0f}°, are not driven."
            )
    # one is enough: the largest amplitude is the first that a slow steering does not reach
    notes += [s for s in (r.run.shortfall(r.amplitude) for side in sides for r in side[-1:]) if s][:1]
    if given.largest < math.radians(270.0) or wanted[-1] >= given.largest * 0.999:
        notes.append(f"The series ends at full lock, {math.degrees(given.largest):.0f}°.")
    return notes


def _plots(ramps: list[SteeredRun], sides: list[list[DwellRun]], least: float) -> list[Plot]:
    plots = []
    ramp = [
        Line(word, np.degrees(np.abs(r.steering)), np.abs(r.acceleration) / G)
        for word, r in zip(("left", "right"), ramps, strict=True)
    ]
    plots.append(Plot("Slowly increasing steer", "angle of the steering wheel, °", "lateral acceleration, g", ramp))
    # first, middle and last run are enough to be seen
    chosen = sorted({0, (len(sides[0]) - 1) // 2, len(sides[0]) - 1}) if sides[0] else []
    some = [sides[0][k] for k in chosen]

    def over_time(title: str, y: str, of: Callable[[SteeredRun], np.ndarray]) -> Plot:
        lines = [Line(f"{math.degrees(r.amplitude):.0f}°", r.run.time, of(r.run)) for r in some if len(r.run.time)]
        return Plot(f"{title}, first to the left", "time, s", y, lines)

    plots.append(over_time("Steering wheel", "angle, °", lambda r: np.degrees(r.steering)))
    plots.append(over_time("Yaw rate", "yaw rate, °/s", lambda r: np.degrees(r.yaw_rate)))

    def over_amplitude(title: str, y: str, of: Callable[[DwellRun], float], limit: float) -> Plot:
        lines = []
        for word, side in zip(("first left", "first right"), sides, strict=True):
            x = np.array([math.degrees(r.amplitude) for r in side])
            lines.append(Line(word, x, np.array([of(r) for r in side])))
        ends = np.array([lines[0].x.min(), max(line.x.max() for line in lines)])
        return Plot(title, "amplitude, °", y, [*lines, Line("limit", ends, np.full(2, limit))])

    return [
        *plots,
        over_amplitude("Yaw rate 1.00 s after", "over its second peak", lambda r: r.measures.ratio_1_00, EARLY),
        over_amplitude("Yaw rate 1.75 s after", "over its second peak", lambda r: r.measures.ratio_1_75, LATE),
        over_amplitude("Displacement 1.07 s after", "displacement, m", lambda r: r.measures.displacement, least),
    ]
