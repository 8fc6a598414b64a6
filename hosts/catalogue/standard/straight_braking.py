"""Braking to rest on a straight at full pedal."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

from hosts.catalogue.braking_measures import measures_of, plots_of
from hosts.catalogue.car import TestedCar
from hosts.catalogue.definition import load_test
from hosts.catalogue.ends import Ends
from hosts.catalogue.preparation import RunUp, early_end, held, with_step_up_to
from hosts.catalogue.record import TestRecord
from hosts.common.wheels import WHEELS
from hosts.driving.pilots.braking import Braking
from hosts.driving.pilots.speed_holder import SpeedHolder
from hosts.driving.pilots.steering import SteeringTable
from hosts.driving.pilots.together import Together
from hosts.driving.result import Result
from hosts.measures.measure import Measure

STEP = 0.005  # s; the pedal rises in a multiple of it
RESOLUTION = 0.01  # of the pedal without locked wheels


def perform(car: TestedCar, settings: Mapping[str, float], progress: Callable[[float], None]) -> TestRecord:
    """See `StandardTest`."""
    car, notes = with_step_up_to(car, STEP, "the rise of the deceleration")
    if settings["neutral"] >= 0.5 and "selector" not in car.facts.inputs:
        notes += ("The car has no selector: it is braked in the gear it has.",)
    result, onset, more = stop(car, settings)
    notes += more
    progress(0.2)
    runs, measures = {"straight_braking": result}, measures_of(result, onset, settings)
    locking = _locks(measures)
    if locking:
        notes += (
            f"Wheels lock at a pedal of {settings['pedal']:g}: {', '.join(locking)}. ISO 21994 is for cars with an "
            "anti-lock system; what the car reaches without a locked wheel is in the measures that begin with "
            "unlocked.",
        )
        best, run = _best_unlocked(car, settings, progress)
        runs |= {"unlocked": run[0]} if run is not None else {}
    else:
        best, run = settings["pedal"], (result, onset)
    measures += _unlocked(best, run, settings)
    progress(1.0)
    return TestRecord(measures, plots_of(result, onset), runs, notes)


def stop(car: TestedCar, settings: Mapping[str, float]) -> tuple[Result, float, tuple[str, ...]]:
    """Drive straight, brake to rest.

    Returns
    -------
    result : Result
    onset : float
        First movement of the pedal, s; NaN if the speed was not reached.
    notes : tuple of str
    """
    nominal = settings["speed"] / 3.6
    neutral = settings["neutral"] >= 0.5 and "selector" in car.facts.inputs
    run_up = RunUp(car, nominal)
    pilot = Braking(
        Together(SteeringTable([0.0], [0.0]), SpeedHolder(nominal, gain=1.0, integral_gain=1.0)),
        run_up.is_over,
        settings["pedal"],
        settings["rise_time"],
        {"selector": (1.0, 0.0)} if neutral else {},
    )
    # a car with less than 1 m/s2 does not brake
    stop_time = run_up.longest + settings["rise_time"] + nominal / 1.0
    ends = Ends(stands=0.02)

    def over(time: float, outputs: Mapping[str, float]) -> bool:
        started = not math.isnan(pilot.onset)
        return (ends(outputs) and (started or ends.reason != "stands")) or (not started and time > run_up.longest)

    result = car.drive(held(car, "straight_braking", stop_time, {}, run_up.start), pilot, over)
    last, notes = result.time[-1], early_end("straight braking", result)
    if math.isnan(pilot.onset):
        notes += (
            f"The car did not hold {settings['speed']:g} km/h: after {last:.4g} s it has "
            f"{3.6 * result['speed'][-1]:.4g} km/h; take a lower speed.",
        )
    elif ends.reason in ("spun", "rolled"):
        notes += (f"The car has {ends.reason} at {last:.4g} s; the run ends there.",)
    elif not ends.reason and not result.failed_steps:
        notes += (f"The car does not stand after {last:.4g} s; its speed is {3.6 * result['speed'][-1]:.3g} km/h.",)
    return result, pilot.onset, notes


def _locks(measures: Sequence[Measure]) -> list[str]:
    """Wheels that lock."""
    return [m.name.partition(".")[2] for m in measures if m.name.startswith("locked_time.") and m.value > 0.0]


def _best_unlocked(
    car: TestedCar, settings: Mapping[str, float], progress: Callable[[float], None]
) -> tuple[float, tuple[Result, float] | None]:
    """The largest pedal below the one that locks wheels, to `RESOLUTION`, with its run."""
    low, high, best = 0.0, settings["pedal"], None
    tries = math.ceil(math.log2(max(high / RESOLUTION, 1.0)))
    for k in range(tries):
        pedal = 0.5 * (low + high)
        result, onset, _ = stop(car, {**settings, "pedal": pedal})
        if math.isnan(onset) or _locks(measures_of(result, onset, {**settings, "pedal": pedal})):
            high = pedal
        else:
            low, best = pedal, (result, onset)
        progress(0.2 + 0.8 * (k + 1) / tries)
    return low, best


def _unlocked(pedal: float, run: tuple[Result, float] | None, settings: Mapping[str, float]) -> list[Measure]:
    """What is reached without a locked wheel."""
    note = f"pedal to within {RESOLUTION:g}" if run is not None else "wheels lock at every pedal"
    made = {m.name: m for m in measures_of(*run, settings)} if run is not None else {}
    told = f"locked_time.{WHEELS[0]}" in made and not math.isnan(made[f"locked_time.{WHEELS[0]}"].value)
    if run is not None and not told:
        note, made = "the car does not tell the slip of its wheels, or did not brake", {}
    rows = [Measure("unlocked.pedal", pedal if made else math.nan, "1", "largest pedal that locks no wheel", note=note)]
    for name in ("stopping_distance", "stopping_distance.corrected", "deceleration.mean_fully_developed"):
        m = made.get(name, Measure(name, math.nan, "m/s2" if "decel" in name else "m", ""))
        # the demand is on a full pedal or less, as long as no wheel locks
        rows.append(
            Measure(f"unlocked.{name}", m.value, m.unit, f"without a locked wheel: {m.text or name}", m.limit, note)
        )
    return rows


TEST = load_test("straight_braking", perform)
