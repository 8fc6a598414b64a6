"""Braking to rest on a straight line at full pedal."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from hosts.catalogue.car import TestedCar
from hosts.catalogue.measure_sheet import Sheet
from hosts.catalogue.preparation import RunUp, StopConditions, constant_inputs, early_end_notes
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.driving.pilots.braking_pilot import Braking
from hosts.driving.pilots.combined_pilot import CombinedPilot
from hosts.driving.pilots.speed_holder import SpeedHolder
from hosts.driving.pilots.steering_table import SteeringTable
from hosts.driving.result import Result

STEP = 0.005  # s; a fraction of the rise time of the pedal
RESOLUTION = 0.01  # of the largest pedal without locked wheels
MIN_DECELERATION = 1.0  # m/s2, for which a run is long enough


@dataclass(frozen=True)
class Stop:
    """A stop from the speed of the test, with the names that the measures read."""

    run: Result
    onset: float
    """Time of the first pedal motion, s; NaN if the speed was not reached."""
    notes: tuple[str, ...]

    @property
    def names(self) -> dict[str, Any]:
        """Values for the expressions of the file."""
        return {"run": self.run, "onset": self.onset}


def drive(sheet: Sheet) -> None:
    """Drive a stop; if wheels lock, also stops with less pedal until none locks."""
    car, settings = sheet.with_step_up_to(STEP, "the rise of the deceleration"), sheet.settings
    sheet.add("selector")
    stop = drive_stop(car, settings)
    sheet.runs["straight_braking"] = stop.run
    sheet.notes += stop.notes
    sheet.progress(0.2)
    sheet.add("stop", **stop.names)
    best_pedal: float = settings["pedal"]
    best: Stop | None = stop
    if sheet.value("locking", **stop.names):
        sheet.add("locked", **stop.names)
        best_pedal, best = _best_unlocked(sheet, car)
        sheet.runs |= {} if best is None else {"unlocked": best.run}
    _add_unlocked(sheet, best_pedal, best)
    sheet.add("pictures", **stop.names)
    sheet.progress(1.0)


def _add_unlocked(sheet: Sheet, pedal: float, stop: Stop | None) -> None:
    """Add the measures of the largest pedal without locked wheels. `stop`: None if wheels lock at every pedal."""
    error = None
    if stop is None:
        error = HostError("wheels lock at every pedal")
    elif not sheet.value("locks_known", **stop.names):
        error = HostError("the car does not provide the slip of its wheels, or did not brake")
    names = {"best": pedal, **stop.names} if stop is not None and error is None else {}
    sheet.add("unlocked", resolution=RESOLUTION, **(names or dict.fromkeys(("best", "run", "onset"), error)))


def drive_stop(
    car: TestedCar, settings: Mapping[str, float], start: Mapping[str, Value] = MappingProxyType({})
) -> Stop:
    """Drive straight and brake to rest. `start`: start values of the car in addition to its speed."""
    speed = settings["speed"] / 3.6
    neutral = settings["neutral"] >= 0.5 and "selector" in car.facts.inputs
    run_up = RunUp(car, speed)
    pilot = Braking(
        CombinedPilot(SteeringTable([0.0], [0.0]), SpeedHolder(speed, gain=1.0, integral_gain=1.0)),
        run_up.is_over,
        settings["pedal"],
        settings["rise_time"],
        {"selector": (1.0, 0.0)} if neutral else {},
    )
    stop_time = run_up.longest + settings["rise_time"] + speed / MIN_DECELERATION
    conditions = StopConditions(stands=0.02)

    def is_over(time: float, outputs: Mapping[str, float]) -> bool:
        if math.isnan(pilot.onset):
            return (conditions(outputs) and conditions.reason != "stands") or time > run_up.longest
        return conditions(outputs)

    manoeuvre = constant_inputs(car, "straight_braking", stop_time, {}, {**run_up.start, **start})
    result = car.drive(manoeuvre, pilot, is_over)
    notes = early_end_notes("straight braking", result)
    return Stop(result, pilot.onset, (*notes, *_end_notes(settings, result, pilot.onset, conditions.reason)))


def _end_notes(settings: Mapping[str, float], result: Result, onset: float, reason: str) -> list[str]:
    """A sentence if the car has not come to rest after braking. `reason`: of the `StopConditions`."""
    end, speed = result.time[-1], 3.6 * result["speed"][-1]
    if math.isnan(onset):
        held = f"The car did not hold {settings['speed']:g} km/h"
        return [f"{held}: after {end:.4g} s it has {speed:.4g} km/h; take a lower speed."]
    if reason in ("spun", "rolled"):
        return [f"The car has {reason} at {end:.4g} s; the run ends there."]
    if not reason and not result.failed_steps:
        return [f"The car has not stopped after {end:.4g} s; its speed is {speed:.3g} km/h."]
    return []


def _best_unlocked(sheet: Sheet, car: TestedCar) -> tuple[float, Stop | None]:
    """The largest pedal without locked wheels, to `RESOLUTION`, with its stop; None: there is none."""
    low, high = 0.0, sheet.settings["pedal"]
    best: Stop | None = None
    run_count = math.ceil(math.log2(max(high / RESOLUTION, 1.0)))
    for k in range(run_count):
        pedal = 0.5 * (low + high)
        stop = drive_stop(car, {**sheet.settings, "pedal": pedal})
        if math.isnan(stop.onset) or sheet.value("locking", **stop.names):
            high = pedal
        else:
            low, best = pedal, stop
        sheet.progress(0.2 + 0.8 * (k + 1) / run_count)
    return low, best
