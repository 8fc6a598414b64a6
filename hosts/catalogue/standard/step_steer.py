"""Step of the steering at a constant speed, to both sides and several lateral accelerations, after ISO 7401."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np

from hosts.catalogue.car import TestedCar
from hosts.catalogue.definition import load_test
from hosts.catalogue.record import Line, Plot, TestRecord
from hosts.catalogue.steady_map import SteadyMap, map_at_reachable_speed
from hosts.catalogue.steered_run import Pedals, steer
from hosts.catalogue.steering import SteeringInput
from hosts.catalogue.stepped_run import SteppedRun, measures_of_step, remarks, stepped
from hosts.driving.result import Result
from hosts.measures.measure import Measure

_LEVELS = ("level_1", "level_2", "level_3")
_CLOSE = 0.02
_MOST_RUNS = 4


def why_not(car: TestedCar, settings: Mapping[str, float]) -> str | None:
    """See `StandardTest`."""
    begin, end = settings["steady_from"], settings["steady_to"]
    if end <= begin:
        return (
            f"The window of the steady state begins at steady_from = {begin:g} s and ends at steady_to = {end:g} "
            "s; it must end later."
        )
    if not any(settings[name] > 0.0 for name in _LEVELS):
        return "level_1, level_2 and level_3 are all 0; one of them must be above 0 m/s²."
    return None


def perform(car: TestedCar, settings: Mapping[str, float], progress: Callable[[float], None]) -> TestRecord:
    """See `StandardTest`."""
    levels = {name: settings[name] for name in _LEVELS if settings[name] > 0.0}
    given = SteeringInput.of(car.facts)
    speed = settings["speed"] / 3.6
    ramp = map_at_reachable_speed(car, speed, min(speed, 80.0 / 3.6), max(levels.values()))
    progress(0.2)
    notes = [*ramp.notes, *filter(None, [given.note])]
    runs: dict[str, Result] = {"ramp_left": ramp.run.thinned()}
    measures = [Measure("speed", ramp.speed, "m/s", "speed at the beginning of the step")]
    driven: list[tuple[float, SteppedRun]] = []
    share = 0.8 / len(levels)
    for k, (name, wanted) in enumerate(levels.items()):
        begin = 0.2 + k * share

        def part(done: float, begin: float = begin) -> None:
            progress(begin + share * done)

        if math.isnan(ramp.angle_at(wanted)):
            notes.append(
                f"At {3.6 * ramp.speed:g} km/h the car reaches {ramp.largest:.3g} m/s² in a slow ramp of the "
                f"steering, not {wanted:g} m/s²: {name} is left out."
            )
            nothing = stepped(ramp.run, (math.inf, math.inf))
            found = measures_of_step(TEST.measures, name, wanted, nothing, nothing, given.is_angle)
            measures += [Measure(m.name, m.value, m.unit, m.text, m.limit, notes[-1]) for m in found]
            continue
        left, right = _both_sides(car, ramp, wanted, settings, part)
        measures += measures_of_step(TEST.measures, name, wanted, left, right, given.is_angle)
        runs |= {f"{name}_left": left.run.thinned(), f"{name}_right": right.run.thinned()}
        notes += remarks(wanted, left, right)
        driven.append((wanted, left))
    return TestRecord(measures, _plots(driven), runs, notes)


TEST = load_test("step_steer", perform, why_not)


def _both_sides(
    car: TestedCar,
    ramp: SteadyMap,
    wanted: float,
    settings: Mapping[str, float],
    progress: Callable[[float], None],
) -> tuple[SteppedRun, SteppedRun]:
    """Runs to both sides with the amplitude that has the wanted steady acceleration to the left."""
    given = SteeringInput.of(car.facts)
    steady = (settings["steady_from"], settings["steady_to"])
    rate = math.radians(settings["steering_rate"])

    def drive(angle: float) -> SteppedRun:
        rise = max(abs(angle) / rate, 1e-3) if given.is_angle else 0.1
        name = f"{wanted:g} m/s2 {'left' if angle > 0.0 else 'right'}"
        time = np.array([0.0, rise, rise + steady[1] + 0.1])
        run = steer(car, name, ramp.speed, time, np.array([0.0, angle, angle]), Pedals.FIXED)
        return stepped(run, steady)

    angle = ramp.angle_at(wanted)
    tried: list[tuple[float, float]] = [(0.0, 0.0)]
    for n in range(_MOST_RUNS):
        left = drive(angle)
        progress((n + 1) / (_MOST_RUNS + 1))
        got = left.acceleration.steady
        tried.append((angle, got))
        if not got > 0.0 or abs(got - wanted) <= _CLOSE * wanted:
            break
        (a0, y0), (a1, y1) = tried[-2:]
        slope = (y1 - y0) / (a1 - a0)
        if not slope > 0.0 or n == _MOST_RUNS - 1:
            break
        # at most half as much again: near the limit the slope says little
        angle = min(a1 + min((wanted - got) / slope, 0.5 * a1), given.largest)
    right = drive(-angle)
    progress(1.0)
    return left, right


def _plots(driven: list[tuple[float, SteppedRun]]) -> list[Plot]:
    """Steps to the left over time."""

    def plot(title: str, y: str, of: Callable[[SteppedRun], np.ndarray]) -> Plot:
        lines = [Line(f"{wanted:g} m/s²", s.run.time, of(s)) for wanted, s in driven if len(s.run.time)]
        return Plot(f"{title}, step to the left", "time, s", y, lines)

    return [
        plot("Steering wheel", "angle, °", lambda s: np.degrees(s.run.steering)),
        plot("Yaw rate", "yaw rate, °/s", lambda s: np.degrees(s.run.yaw_rate)),
        plot("Lateral acceleration", "lateral acceleration, m/s²", lambda s: s.run.acceleration),
        plot("Sideslip angle", "sideslip angle, °", lambda s: np.degrees(s.run.sideslip)),
        plot("Roll angle", "roll angle, °", lambda s: np.degrees(s.run.roll)),
    ]
