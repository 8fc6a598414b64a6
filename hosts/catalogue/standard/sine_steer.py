"""One period of sinusoidal steering, to both sides, after ISO 7401."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from hosts.catalogue.car import TestedCar
from hosts.catalogue.definition import load_test
from hosts.catalogue.record import Line, Plot, TestRecord
from hosts.catalogue.steady_map import map_at_reachable_speed
from hosts.catalogue.steered_run import Pedals, SteeredRun, steer
from hosts.catalogue.steering import SteeringInput
from hosts.catalogue.two_sides import asymmetry, mean_of_sides
from hosts.measures.measure import Measure
from hosts.measures.one_period import NOTHING, OnePeriod, one_period

_AFTER = 2.0
_POINTS = 400


def perform(car: TestedCar, settings: Mapping[str, float], progress: Callable[[float], None]) -> TestRecord:
    """See `StandardTest`."""
    given = SteeringInput.of(car.facts)
    speed, wanted = settings["speed"] / 3.6, settings["lateral_acceleration"]
    ramp = map_at_reachable_speed(car, speed, min(speed, 80.0 / 3.6), wanted)
    progress(0.4)
    amplitude = ramp.need_angle_at(wanted)
    period = 1.0 / settings["frequency"]
    t = np.linspace(0.0, period, _POINTS + 1)
    sine = np.append(np.sin(2.0 * math.pi * t / period), 0.0)
    sides: list[SteeredRun] = []
    for n, side in enumerate((1.0, -1.0)):
        name = f"sine {'left' if side > 0.0 else 'right'}"
        time = np.append(t, period + _AFTER)
        sides.append(steer(car, name, ramp.speed, time, side * amplitude * sine, Pedals.FIXED))
        progress(0.4 + 0.3 * (n + 1))
    notes = [*ramp.notes, *filter(None, [given.note])]
    for run, side_name in zip(sides, ("left", "right"), strict=True):
        if not run.whole:
            notes.append(f"The run that begins to the {side_name} ended early; what needs all of it is missing.")
    notes += sorted(set(filter(None, [run.shortfall(amplitude) for run in sides])))
    angle_unit = "rad" if given.is_angle else "1"
    measures = [
        Measure("speed", ramp.speed, "m/s", "speed at the beginning"),
        Measure(
            "steering_wheel_angle", amplitude, angle_unit, f"amplitude of the steering for a steady {wanted:g} m/s²"
        ),
    ]
    measures += _measures(
        "yaw_rate", "yaw rate", sides, lambda r: r.yaw_rate, "1/s" if given.is_angle else "rad/s", period
    )
    measures += _measures(
        "lateral_acceleration",
        "lateral acceleration",
        sides,
        lambda r: r.acceleration,
        "m/(s2.rad)" if given.is_angle else "m/s2",
        period,
    )
    runs = {"ramp_left": ramp.run.thinned(), "sine_left": sides[0].thinned(), "sine_right": sides[1].thinned()}
    return TestRecord(measures, _plots(sides[0]), runs, notes)


TEST = load_test("sine_steer", perform)


def _relative(
    run: SteeredRun, values: NDArray[np.float64], period: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Time, steering and a signal from the beginning to when the car runs straight again, less their values before."""
    before, kept = run.time < 0.0, (run.time >= 0.0) & (run.time <= period + _AFTER)

    def part(x: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.asarray(x[kept] - (x[before].mean() if before.any() else x[0]))

    return run.time[kept], part(run.steering), part(values)


def _measures(
    name: str,
    word: str,
    sides: list[SteeredRun],
    of: Callable[[SteeredRun], NDArray[np.float64]],
    unit: str,
    period: float,
) -> list[Measure]:
    left, right = (
        one_period(*_relative(run, of(run), period), longest=0.45 * period) if run.whole else NOTHING for run in sides
    )

    def made(end: str, value: Callable[[OnePeriod], float], unit: str, text: str) -> Measure:
        return mean_of_sides(f"{name}.{end}", value(left), value(right), unit, text)

    return [
        made("lag", lambda p: p.correlation_lag, "s", f"lag of the {word} behind the steering, by cross-correlation"),
        made(
            "correlation",
            lambda p: p.correlation,
            "1",
            f"coefficient of correlation of the {word} and the steering at its lag",
        ),
        made(
            "first_lag", lambda p: p.first_lag, "s", f"time from the first peak of the steering to that of the {word}"
        ),
        made(
            "second_lag",
            lambda p: p.second_lag,
            "s",
            f"time from the second peak of the steering to that of the {word}",
        ),
        made("first_ratio", lambda p: p.first_ratio, unit, f"first peak of the {word} over that of the steering"),
        made("second_ratio", lambda p: p.second_ratio, unit, f"second peak of the {word} over that of the steering"),
        made(
            "hysteresis", lambda p: p.hysteresis, "1", f"area of the loop of {word} over steering; pure lag: its sine"
        ),
        asymmetry(
            f"{name}.asymmetry",
            [(left.first_ratio, right.first_ratio)],
            f"difference of the first ratio of the {word} left and right over their mean",
        ),
    ]


def _plots(left: SteeredRun) -> list[Plot]:
    """The run that begins to the left."""
    if not len(left.time):
        return []
    angle = np.degrees(left.steering)
    return [
        Plot("Steering wheel, one period", "time, s", "angle, °", [Line("steering wheel", left.time, angle)]),
        Plot(
            "Yaw rate, one period", "time, s", "yaw rate, °/s", [Line("yaw rate", left.time, np.degrees(left.yaw_rate))]
        ),
        Plot(
            "Lateral acceleration, one period",
            "time, s",
            "lateral acceleration, m/s²",
            [Line("lateral acceleration", left.time, left.acceleration)],
        ),
        Plot(
            "Yaw rate over steering",
            "angle of the steering wheel, °",
            "yaw rate, °/s",
            [Line("yaw rate", angle, np.degrees(left.yaw_rate))],
        ),
        Plot(
            "Lateral acceleration over steering",
            "angle of the steering wheel, °",
            "lateral acceleration, m/s²",
            [Line("lateral acceleration", angle, left.acceleration)],
        ),
    ]
