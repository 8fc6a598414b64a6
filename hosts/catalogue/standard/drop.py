"""Free fall onto four wheels: a test of the springs, the stops and of the balance of forces at rest."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from hosts.catalogue.car import TestedCar
from hosts.catalogue.definition import load_test
from hosts.catalogue.preparation import early_end, held, with_step_up_to
from hosts.catalogue.record import Line, Plot, TestRecord
from hosts.common.wheels import WHEELS
from hosts.driving.result import Result
from hosts.measures.impact import fall_time, first_contact, rebound, settling_time, weight_from_momentum
from hosts.measures.measure import Limit, Measure
from hosts.measures.wheels import at_wheels, duration, lifted_wheels

STEP = 0.002  # s; a peak of the load lasts some 10 ms
BALANCE = Limit("balance of forces at rest", -1e-3, 1e-3)


def perform(car: TestedCar, settings: Mapping[str, float], progress: Callable[[float], None]) -> TestRecord:
    """See `StandardTest`."""
    car, notes = with_step_up_to(car, STEP, "the peak of the load")
    inputs = {"steering": 0.0, "throttle": 0.0, "brake": 0.3}
    manoeuvre = held(car, "drop", settings["duration"], inputs, {"initial.z": settings["height"]})
    result = car.drive(manoeuvre)
    progress(1.0)
    notes += early_end("drop", result)
    return TestRecord(measures_of(result, settings), plots_of(result), {"drop": result}, notes)


def total_load(result: Result) -> NDArray[np.float64]:
    """All that the road carries, N, of shape (n,)."""
    loads = at_wheels(result, "Fz")
    assert loads is not None  # one of the needs
    total = loads.sum(axis=1)
    if "chassis.ground_force" in result:
        total = total + result["chassis.ground_force"]
    return np.asarray(total)


def measures_of(result: Result, settings: Mapping[str, float]) -> list[Measure]:
    """Measures of a drop. `result`: from the start of the fall."""
    time, load = result.time, total_load(result)
    loads = at_wheels(result, "Fz")
    assert loads is not None
    contact, ended = first_contact(time, load), bool(result.failed_steps)
    peak = float(loads.sum(axis=1).max())
    step = float(time[1] - time[0]) if len(time) > 1 else math.nan
    short = "" if not ended else "the run ended early"
    weight = math.nan if ended or math.isnan(contact) else weight_from_momentum(time, load)
    settled = settling_time(time, load, weight, settings["band"] * weight) - contact if weight > 0.0 else math.nan
    within = f"to within the step of {step:g} s, in which it begins"
    late = "" if not math.isnan(settled) or ended else f"not settled after {time[-1]:g} s; take a longer duration"
    at_rest = short or late
    return [
        Measure("contact.time", contact, "s", "time from release to the first wheel's contact", note=within),
        Measure(
            "contact.free_fall_time",
            fall_time(settings["height"], settings["gravity"]),
            "s",
            "time of fall of a point from the height; wheels touch earlier by as much as they droop in the air",
        ),
        _fall(result, contact, weight, settings["gravity"]),
        Measure("load.peak", peak, "N", "largest sum of the loads of the wheels"),
        Measure(
            "load.peak_ratio", peak / weight, "1", "largest sum of the loads of the wheels over the weight", note=short
        ),
        *(
            Measure(f"load.peak_{wheel}", float(loads[:, k].max()), "N", f"largest load of the wheel {wheel}")
            for k, wheel in enumerate(WHEELS)
        ),
        _on_chassis(result),
        *_travels(result),
        *_rebounds(result, loads, contact),
        Measure("settling_time", settled, "s", "time from contact until the load stays in the band", note=at_rest),
        Measure("rest.weight", weight, "N", "mean load over the run: momentum is zero at both ends", note=short),
        Measure(
            "rest.load_error",
            float(load[-1]) / weight - 1.0 if not at_rest else math.nan,
            "1",
            "sum of the loads at the end over the weight, less 1",
            BALANCE,
            at_rest,
        ),
        Measure(
            "rest.front_share",
            float(loads[-1, :2].sum() / loads[-1].sum()) if not at_rest else math.nan,
            "1",
            "share of the front wheels in the load at the end",
            note=at_rest,
        ),
    ]


def _fall(result: Result, contact: float, weight: float, gravity: float) -> Measure:
    """Acceleration of the centre of mass of the whole car in the air, from its energy in the field of gravity."""
    text = "acceleration of the centre of mass in the air"
    limit = Limit("free fall", 0.99 * gravity, 1.01 * gravity)
    falling = result.time < contact
    if "energy.gravity" not in result or math.isnan(weight) or falling.sum() < 5:
        why = "it needs energy.gravity, a whole run and five samples in the air"
        return Measure("fall.acceleration", math.nan, "m/s2", text, None, why)
    # the last sample before the contact may end a step that touched between
    time, height = result.time[falling][:-1], result["energy.gravity"][falling][:-1] / weight
    return Measure("fall.acceleration", -2.0 * float(np.polyfit(time, height, 2)[0]), "m/s2", text, limit)


def _on_chassis(result: Result) -> Measure:
    name, text = "load.peak_chassis", "largest load of the road on the chassis itself; 0: it did not touch"
    if "chassis.ground_force" not in result:
        return Measure(name, math.nan, "N", text, note="the car does not tell it")
    return Measure(name, float(result["chassis.ground_force"].max()), "N", text)


def _travels(result: Result) -> list[Measure]:
    travel = at_wheels(result, "travel")
    note = "" if travel is not None else "the car does not tell the travel of its wheels"
    most, least = (float(travel.max()), float(travel.min())) if travel is not None else (math.nan, math.nan)
    return [
        Measure("travel.bump", most, "m", "largest travel of a wheel", note=note),
        Measure("travel.droop", least, "m", "least travel of a wheel, negative in droop", note=note),
    ]


def _rebounds(result: Result, loads: NDArray[np.float64], contact: float) -> list[Measure]:
    after = result.time >= contact
    airborne = duration(result.time[after], np.all(lifted_wheels(loads[after]), axis=1)) if after.any() else math.nan
    height, note = math.nan, "the car does not tell its height"
    if "chassis.z" in result and after.any():
        z, note = result["chassis.z"][after], ""
        height = float(z[rebound(z)[1]] - z[-1])
    return [
        Measure("rebound.height", height, "m", "highest point after the first contact over that at the end", note=note),
        Measure("rebound.airborne_time", airborne, "s", "after the first contact with no wheel on the road"),
    ]


def plots_of(result: Result) -> list[Plot]:
    """Load, height and travel over time."""
    time, loads = result.time, at_wheels(result, "Fz")
    assert loads is not None
    lines = [Line("wheels", time, loads.sum(axis=1))]
    if "chassis.ground_force" in result and result["chassis.ground_force"].any():
        lines.append(Line("chassis", time, result["chassis.ground_force"]))
    plots = [Plot("Load on the road", "time, s", "load, N", lines)]
    if "chassis.z" in result:
        plots.append(
            Plot("Height", "time, s", "height of the reference point, m", [Line("", time, result["chassis.z"])])
        )
    travel = at_wheels(result, "travel")
    if travel is not None:
        lines = [Line(name, time, travel[:, k]) for k, name in ((0, "front left"), (2, "rear left"))]
        plots.append(Plot("Wheel travel", "time, s", "travel, positive in bump, m", lines))
    return plots


TEST = load_test("drop", perform)
