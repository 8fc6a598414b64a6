"""Sine with dwell of growing amplitude, to both sides, after 49 CFR 571.126 (FMVSS 126) and ISO 19365."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np

from hosts.catalogue.car import TestedCar
from hosts.catalogue.dwell_measures import EARLY, LATE, least_displacement, measures_of_dwell
from hosts.catalogue.dwell_series import DwellRun, amplitudes, processed, series
from hosts.catalogue.plausible import implausible
from hosts.catalogue.record import Clause, Line, Plot, Setting, Standard, TestRecord
from hosts.catalogue.steady_map import why_not_reached
from hosts.catalogue.steered_run import Pedals, SteeredRun, steer
from hosts.catalogue.steering import NEED, SteeringInput
from hosts.common.errors import HostError
from hosts.driving.result import Result
from hosts.measures.slowly_increasing_steer import G, angle_by_regression

_RATE = math.radians(13.5)
_RAMP_TO = 0.5 * G
_MOST_RUNS = 80
_TRANSLATED = "Read in an English translation: "


class SineWithDwellTest:
    """See `hosts.catalogue.record.StandardTest`."""

    name = "sine_with_dwell"
    title = "Sine with dwell"
    standards = (
        Standard(
            "49 CFR 571.126 (FMVSS 126)",
            "Electronic stability control systems for light vehicles",
            (
                Clause("S5.2.1", "Yaw rate 1.00 s after the completion of steer at most 35 % of its second peak."),
                Clause("S5.2.2", "Yaw rate 1.75 s after the completion of steer at most 20 % of its second peak."),
                Clause(
                    "S5.2.3", "Lateral displacement 1.07 s after the start at least 1.83 m up to 3500 kg, else 1.52 m."
                ),
                Clause("S7.6", "A: mean angle at 0.3 g of slow ramps of 13.5 °/s to both sides, by linear regression."),
                Clause("S7.9", "0.7 Hz with a dwell of 0.5 s, from 1.5 A in steps of 0.5 A to the last amplitude."),
                Clause("S7.11", "12-pole phaseless Butterworth filters of 10 Hz and 6 Hz; begin of steer at 5°."),
            ),
        ),
        Standard(
            "GB/T 30677-2014",
            "Electronic stability control systems for light vehicles, after UN global technical regulation 8",
            (
                Clause("5.1.1", _TRANSLATED + "the displacement counts from 5 A upward.", True),
                Clause("5.1.2", _TRANSLATED + "yaw rate at most 35 % after 1 s.", True),
                Clause("5.1.3", _TRANSLATED + "yaw rate at most 20 % after 1.75 s.", True),
                Clause(
                    "5.1.4", _TRANSLATED + "displacement after 1.07 s at least 1.83 m up to 3500 kg, else 1.52 m.", True
                ),
                Clause(
                    "7.6", _TRANSLATED + "ramps of 13.5 °/s at 80 km/h; here A is at 0.3 g, there at 3.0 m/s².", True
                ),
                Clause("7.7.3", _TRANSLATED + "sine of 0.7 Hz that rests at its second peak for 0.5 s.", True),
                Clause(
                    "7.7.4",
                    _TRANSLATED + "the car coasts at 80 km/h within 2 km/h. Here the selector is not touched.",
                    True,
                ),
                Clause("7.7.5", _TRANSLATED + "from 1.5 A in steps of 0.5 A.", True),
                Clause(
                    "7.7.6", _TRANSLATED + "last: the greater of 6.5 A and 270°; 300° where 6.5 A is above it.", True
                ),
                Clause("7.10", _TRANSLATED + "filters, zeroing, begin and completion, second peak, integrals.", True),
            ),
        ),
        Standard(
            "ISO 19365:2016",
            "Passenger cars: validation of vehicle dynamic simulation, sine with dwell stability control testing",
            (Clause("", "The same manoeuvre, as a comparison of a simulation with measurements."),),
        ),
    )
    settings = (
        Setting("speed", 80.0, "km/h", "when the steering begins, coasting", 30.0, 200.0),
        Setting("first", 1.5, "1", "first amplitude over A", 0.5, 10.0),
        Setting("increment", 0.5, "1", "of the amplitude, over A", 0.1, 10.0),
        Setting(
            "gross_mass", 3500.0, "kg", "gross vehicle mass: above 3500 kg the displacement is 1.52 m", 100.0, 60000.0
        ),
    )
    needs = ("chassis.wz", "chassis.ay", "speed", "throttle", NEED)

    def why_not(self, car: TestedCar, settings: Mapping[str, float]) -> str | None:
        """Why the test cannot be done with this car; None if it can."""
        return SteeringInput.of(car.facts).why_no_angles(self.name)

    def perform(self, car: TestedCar, settings: Mapping[str, float], progress: Callable[[float], None]) -> TestRecord:
        given = SteeringInput.of(car.facts)
        speed = settings["speed"] / 3.6
        ramps = []
        for side in (1.0, -1.0):
            ramps.append(_ramp(car, speed, side, given.largest))
            progress(0.1 * len(ramps))
        wrong = implausible(ramps[0])
        if wrong is not None:
            raise HostError(wrong)
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


TEST = SineWithDwellTest()


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
