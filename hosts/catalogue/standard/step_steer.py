"""Step of the steering at a constant speed, to both sides and several lateral accelerations, after ISO 7401."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from hosts.catalogue.definition import load_test
from hosts.catalogue.sheet import Sheet
from hosts.catalogue.steady_map import SteadyMap, driven_ramp
from hosts.catalogue.steered_run import Pedals, SteeredRun, steer
from hosts.catalogue.steering import SteeringInput
from hosts.measures.step_response import step_of_steering

_BEFORE, _CLOSE, _MOST_RUNS = (-0.8, 0.0), 0.02, 4


def drive(sheet: Sheet) -> None:
    """A slow ramp, then a step to both sides at each level."""
    levels = {n: x for n in ("level_1", "level_2", "level_3") if (x := sheet.settings[n]) > 0.0}
    ramp = driven_ramp(sheet, max(levels.values()))
    sheet.add("speed", speed=ramp.speed)
    given, driven = SteeringInput.of(sheet.car.facts), []
    for k, (level, wanted) in enumerate(levels.items()):
        names: dict[str, Any] = {"level": level, "wanted": wanted, "is_angle": given.is_angle}
        if math.isnan(ramp.angle_at(wanted)):
            why = (
                f"At {3.6 * ramp.speed:g} km/h the car reaches {ramp.largest:.3g} m/s² in a slow ramp of the "
                f"steering, not {wanted:g} m/s²: {level} is left out."
            )
            sheet.notes.append(why)
            nothing = _responses(ramp.run, (math.inf, math.inf))
            sheet.add("level", why_none=why, left=nothing, right=nothing, **names)
            continue
        begin, share = 0.2 + 0.8 * k / len(levels), 0.8 / len(levels)
        sides = _both_sides(sheet, ramp, wanted, lambda done, b=begin, s=share: sheet.progress(b + s * done))  # type: ignore[misc]
        sheet.runs |= {f"{level}_{side}": found["run"].thinned() for side, found in sides.items()}
        sheet.add("level", **sides, **names)
        sheet.add("steadiness", **sides, **names)
        driven.append({"wanted": wanted, "run": sides["left"]["run"]})
    sheet.add("pictures", driven=driven)


TEST = load_test("step_steer", drive)


def _responses(run: SteeredRun, steady: tuple[float, float]) -> dict[str, Any]:
    signals = {name: getattr(run, name) for name in ("yaw_rate", "acceleration", "roll", "sideslip")}
    return {"run": run, **step_of_steering(run.time, run.steering, signals, _BEFORE, steady)}


def _both_sides(
    sheet: Sheet, ramp: SteadyMap, wanted: float, progress: Callable[[float], None]
) -> dict[str, dict[str, Any]]:
    """Runs to both sides with the amplitude that has the wanted steady acceleration to the left."""
    given, settings = SteeringInput.of(sheet.car.facts), sheet.settings
    steady = (settings["steady_from"], settings["steady_to"])

    def step(angle: float) -> dict[str, Any]:
        rise = max(abs(angle) / math.radians(settings["steering_rate"]), 1e-3) if given.is_angle else 0.1
        name = f"{wanted:g} m/s2 {'left' if angle > 0.0 else 'right'}"
        time, table = np.array([0.0, rise, rise + steady[1] + 0.1]), np.array([0.0, angle, angle])
        return _responses(steer(sheet.car, name, ramp.speed, time, table, Pedals.FIXED), steady)

    angle, before = ramp.angle_at(wanted), (0.0, 0.0)
    for n in range(_MOST_RUNS):
        left = step(angle)
        progress((n + 1) / (_MOST_RUNS + 1))
        got = left["acceleration"].steady
        slope = (got - before[1]) / (angle - before[0])
        if not got > 0.0 or abs(got - wanted) <= _CLOSE * wanted or not slope > 0.0 or n == _MOST_RUNS - 1:
            break
        # at most half as much again: near the limit the slope says little
        before, angle = (angle, got), min(angle + min((wanted - got) / slope, 0.5 * angle), given.largest)
    right = step(-angle)
    progress(1.0)
    return {"left": left, "right": right}
