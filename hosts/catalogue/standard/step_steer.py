"""Step of the steering at a constant speed, to both sides and several lateral accelerations, after ISO 7401."""

import math
from typing import Any

import numpy as np

from hosts.catalogue.measure_sheet import Sheet
from hosts.catalogue.steady_map import driven_ramp
from hosts.catalogue.steered_run import Pedals, steer
from hosts.catalogue.steering import SteeringInput
from hosts.common.errors import HostError
from hosts.measures.step_response import step_of_steering

_BEFORE = (-0.8, 0.0)
_CLOSE = 0.02
_MOST_RUNS = 4


def drive(sheet: Sheet) -> None:
    """A slow ramp, then a step to both sides at each level."""
    levels = {n: x for n in ("level_1", "level_2", "level_3") if (x := sheet.settings[n]) > 0.0}
    ramp = driven_ramp(sheet, max(levels.values()))
    driven = []
    for k, (level, acceleration) in enumerate(levels.items()):
        try:
            angle = ramp.need_angle_at(acceleration, level)
        except HostError as error:
            sheet.notes.append(str(error))
            sides: dict[str, Any] = dict.fromkeys(("left", "right"), error)
        else:
            left = _to_the_left(sheet, ramp.speed, acceleration, angle, 0.2 + 0.8 * k / len(levels))
            sides = {"left": left, "right": _step(sheet, ramp.speed, acceleration, -left["given"])}
            sheet.runs |= {f"{level}_{side}": step["run"].thinned() for side, step in sides.items()}
            driven.append({"wanted": acceleration, "run": left["run"]})
        sheet.progress(0.2 + 0.8 * (k + 1) / len(levels))
        sheet.add("level", level=level, wanted=acceleration, **sides)
    sheet.add("pictures", driven=driven)


def _to_the_left(sheet: Sheet, speed: float, acceleration: float, angle: float, done: float) -> dict[str, Any]:
    """The step of the wanted steady acceleration, by secants from an angle on; `done`: of the test before it."""
    largest_angle, before = SteeringInput.of(sheet.car.facts).largest, (0.0, 0.0)
    for n in range(_MOST_RUNS):
        left = _step(sheet, speed, acceleration, angle)
        sheet.progress(done + 0.05 * (n + 1))
        reached = left["acceleration"].steady
        slope = (reached - before[1]) / (angle - before[0])
        if not reached > 0.0 or abs(reached - acceleration) <= _CLOSE * acceleration or not slope > 0.0:
            break
        # at most half as much again: near the limit the slope says little
        before, angle = (angle, reached), min(angle + min((acceleration - reached) / slope, 0.5 * angle), largest_angle)
    return left


def _step(sheet: Sheet, speed: float, acceleration: float, angle: float) -> dict[str, Any]:
    """A step to an angle, its run and the responses to it."""
    settings, is_angle = sheet.settings, SteeringInput.of(sheet.car.facts).is_angle
    steady = settings["steady_from"], settings["steady_to"]
    rise = max(abs(angle) / math.radians(settings["steering_rate"]), 1e-3) if is_angle else 0.1
    time, table = np.array([0.0, rise, rise + steady[1] + 0.1]), np.array([0.0, angle, angle])
    run = steer(
        sheet.car, f"{acceleration:g} m/s2 {'left' if angle > 0.0 else 'right'}", speed, time, table, Pedals.FIXED
    )
    signals = {n: getattr(run, n) for n in ("yaw_rate", "acceleration", "roll", "sideslip")}
    return {"given": angle, "run": run, **step_of_steering(run.time, run.steering, signals, _BEFORE, steady)}
