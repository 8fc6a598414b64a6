"""Step of the steering at a constant speed, to both sides and several lateral accelerations, after ISO 7401."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from hosts.catalogue.definition import load_test
from hosts.catalogue.sheet import Sheet
from hosts.catalogue.steady_map import SteadyMap, driven_ramp
from hosts.catalogue.steered_run import Pedals, steer
from hosts.catalogue.steering import SteeringInput
from hosts.common.errors import HostError
from hosts.measures.step_response import step_of_steering

_BEFORE, _CLOSE, _MOST_RUNS = (-0.8, 0.0), 0.02, 4
_SIGNALS = ("yaw_rate", "acceleration", "roll", "sideslip")


def drive(sheet: Sheet) -> None:
    """A slow ramp, then a step to both sides at each level."""
    levels = {n: x for n in ("level_1", "level_2", "level_3") if (x := sheet.settings[n]) > 0.0}
    ramp = driven_ramp(sheet, max(levels.values()))
    sheet.add("speed", speed=ramp.speed)
    driven = []
    for k, (level, wanted) in enumerate(levels.items()):
        if math.isnan(ramp.angle_at(wanted)):
            reached = (
                f"{ramp.largest:.3g} m/s² in a slow ramp of the steering, not {wanted:g} m/s²: {level} is left out."
            )
            sheet.notes.append(f"At {3.6 * ramp.speed:g} km/h the car reaches {reached}")
            sides: dict[str, Any] = dict.fromkeys(("left", "right"), HostError(sheet.notes[-1]))
        else:
            sides = _both_sides(sheet, ramp, wanted, 0.2 + 0.8 * k / len(levels), 0.8 / len(levels))
            sheet.runs |= {f"{level}_{side}": found["run"].thinned() for side, found in sides.items()}
            driven.append({"wanted": wanted, "run": sides["left"]["run"]})
        sheet.add("level", level=level, wanted=wanted, **sides)
    sheet.add("pictures", driven=driven)


TEST = load_test("step_steer", drive)


def _both_sides(sheet: Sheet, ramp: SteadyMap, wanted: float, begin: float, share: float) -> dict[str, dict[str, Any]]:
    """Runs to both sides with the amplitude that has the wanted steady acceleration to the left.

    `begin`, `share`: what is done before, and these runs, of the whole test.
    """
    given, steady = SteeringInput.of(sheet.car.facts), (sheet.settings["steady_from"], sheet.settings["steady_to"])

    def step(angle: float) -> dict[str, Any]:
        rise = max(abs(angle) / math.radians(sheet.settings["steering_rate"]), 1e-3) if given.is_angle else 0.1
        time, table = np.array([0.0, rise, rise + steady[1] + 0.1]), np.array([0.0, angle, angle])
        name = f"{wanted:g} m/s2 {'left' if angle > 0.0 else 'right'}"
        run = steer(sheet.car, name, ramp.speed, time, table, Pedals.FIXED)
        signals = {name: getattr(run, name) for name in _SIGNALS}
        return {"run": run, **step_of_steering(run.time, run.steering, signals, _BEFORE, steady)}

    angle, before = ramp.angle_at(wanted), (0.0, 0.0)
    for n in range(_MOST_RUNS):
        left = step(angle)
        sheet.progress(begin + share * (n + 1) / (_MOST_RUNS + 1))
        got = left["acceleration"].steady
        slope = (got - before[1]) / (angle - before[0])
        if not got > 0.0 or abs(got - wanted) <= _CLOSE * wanted or not slope > 0.0 or n == _MOST_RUNS - 1:
            break
        # at most half as much again: near the limit the slope says little
        before, angle = (angle, got), min(angle + min((wanted - got) / slope, 0.5 * angle), given.largest)
    right = step(-angle)
    sheet.progress(begin + share)
    return {"left": left, "right": right}
