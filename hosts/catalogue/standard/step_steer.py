"""Step steer at constant speed, to both sides and at several lateral accelerations, after ISO 7401."""

import math
from typing import Any

import numpy as np

from hosts.catalogue.measure_sheet import Sheet
from hosts.catalogue.steady_map import drive_ramp
from hosts.catalogue.steered_run import Pedals, steer
from hosts.catalogue.steering import SteeringInput
from hosts.common.errors import HostError
from hosts.measures.step_response import step_of_steering

_BEFORE_STEP = (-0.8, 0.0)  # s
_TOLERANCE = 0.02  # of the steady lateral acceleration
_MAX_RUNS = 4  # to find the angle of a step


def drive(sheet: Sheet) -> None:
    """Drive a slow ramp, then a step to both sides at each level."""
    levels = {n: x for n in ("level_1", "level_2", "level_3") if (x := sheet.settings[n]) > 0.0}
    ramp = drive_ramp(sheet, max(levels.values()))
    driven = []
    for k, (level, acceleration) in enumerate(levels.items()):
        try:
            angle = ramp.required_angle_at(acceleration, level)
        except HostError as error:
            sheet.notes.append(str(error))
            sides: dict[str, Any] = dict.fromkeys(("left", "right"), error)
        else:
            left = _find_left_step(sheet, ramp.speed, acceleration, angle, 0.2 + 0.8 * k / len(levels))
            sides = {"left": left, "right": _drive_step(sheet, ramp.speed, acceleration, -left["demand"])}
            sheet.runs |= {f"{level}_{side}": step["run"].thinned() for side, step in sides.items()}
            driven.append({"target": acceleration, "run": left["run"]})
        sheet.progress(0.2 + 0.8 * (k + 1) / len(levels))
        sheet.add("level", level=level, target=acceleration, **sides)
    sheet.add("pictures", driven=driven)


def _find_left_step(sheet: Sheet, speed: float, acceleration: float, angle: float, done: float) -> dict[str, Any]:
    """The step to the left with a steady lateral acceleration, m/s2, by the secant method.

    `angle`: first guess, rad; `done`: progress of the test before it.
    """
    largest_angle, last_point = SteeringInput.of(sheet.car.facts).largest, (0.0, 0.0)
    for attempt in range(_MAX_RUNS):
        step = _drive_step(sheet, speed, acceleration, angle)
        sheet.progress(done + 0.05 * (attempt + 1))
        reached = step["acceleration"].steady
        slope = (reached - last_point[1]) / (angle - last_point[0])
        if not reached > 0.0 or abs(reached - acceleration) <= _TOLERANCE * acceleration or not slope > 0.0:
            break
        # At most 1.5 times the angle: near the limit the slope is unreliable.
        last_point = angle, reached
        angle = min(angle + min((acceleration - reached) / slope, 0.5 * angle), largest_angle)
    return step


def _drive_step(sheet: Sheet, speed: float, acceleration: float, angle: float) -> dict[str, Any]:
    """Drive a step to an angle, rad. Returns its demand, its run and the responses."""
    settings, is_angle = sheet.settings, SteeringInput.of(sheet.car.facts).is_angle
    steady = settings["steady_from"], settings["steady_to"]
    rise = max(abs(angle) / math.radians(settings["steering_rate"]), 1e-3) if is_angle else 0.1
    time, table = np.array([0.0, rise, rise + steady[1] + 0.1]), np.array([0.0, angle, angle])
    run = steer(
        sheet.car, f"{acceleration:g} m/s2 {'left' if angle > 0.0 else 'right'}", speed, time, table, Pedals.FIXED
    )
    signals = {n: getattr(run, n) for n in ("yaw_rate", "acceleration", "roll", "sideslip")}
    return {"demand": angle, "run": run, **step_of_steering(run.time, run.steering, signals, _BEFORE_STEP, steady)}
