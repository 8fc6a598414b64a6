"""Measures and plots of a stop on a straight."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import trapezoid

from hosts.catalogue.record import Line, Plot
from hosts.common.wheels import WHEELS
from hosts.driving.result import Result
from hosts.measures.braking import (
    corrected_to,
    locked,
    mean_fully_developed_deceleration,
    stopping_distance,
    time_to_reach,
    travelled,
)
from hosts.measures.measure import Limit, Measure
from hosts.measures.wheels import at_wheels, duration

WORKS = ("energy.drive", "energy.brakes", "energy.tyres", "energy.dampers", "energy.drag", "energy.ground")
_R13H = "UN R13-H Annex 3, type 0 with the engine disconnected, at 100 km/h"
_SLOWEST_LOCKED = 15.0 / 3.6  # m/s; slower, the regulation lets wheels lock
NOT_BRAKED = "braking did not begin"


def deceleration_of(result: Result) -> NDArray[np.float64]:
    """Deceleration along the vehicle, m/s2, of shape (n,); of the speed where the car does not tell it."""
    if "chassis.ax" in result:
        return -result["chassis.ax"]
    return -np.gradient(result["speed"], result.time) if len(result.time) > 1 else np.zeros(1)


def measures_of(result: Result, onset: float, settings: Mapping[str, float]) -> list[Measure]:
    """Measures of a stop.

    `result`: from before the onset to rest; `onset`: first movement of the pedal, s; NaN if braking did not begin;
    `settings`: ``speed``, km/h, and ``pedal``. Returns the same names whatever the car tells; NaN with a note where it
    does not.
    """
    time, speed, nominal = result.time, result["speed"], settings["speed"] / 3.6
    began = not math.isnan(onset)
    # A row holds the outputs at its time: the one at the onset is the last of driving straight.
    first = int(np.searchsorted(time, onset - 1e-9)) if began else len(time) - 1
    first = min(first, len(time) - 1)
    initial = float(speed[first]) if began else math.nan
    mean = mean_fully_developed_deceleration(time, speed, onset, initial) if began else math.nan
    distance = stopping_distance(time, speed, onset, mean)
    deceleration = deceleration_of(result)
    moving = (time >= onset) & (speed > 0.1 * initial)
    developed = moving & (speed <= 0.8 * initial)
    why = NOT_BRAKED if not began else "the car did not come to rest" if math.isnan(distance) else ""
    legal = began and abs(settings["speed"] - 100.0) < 0.05 and settings["pedal"] == 1.0
    demand = 0.1 * settings["speed"] + 0.006 * settings["speed"] ** 2
    return [
        Measure(
            "initial_speed",
            initial,
            "m/s",
            "speed at the first movement of the pedal",
            note="" if began else NOT_BRAKED,
        ),
        Measure("stopping_distance", distance, "m", "way from the first movement of the pedal to rest", note=why),
        Measure(
            "stopping_distance.corrected",
            corrected_to(nominal, distance, initial),
            "m",
            "way to rest, corrected to the nominal speed",
            Limit(_R13H, highest=demand) if legal else None,
            why,
        ),
        Measure(
            "deceleration.mean_fully_developed",
            mean,
            "m/s2",
            "mean deceleration over the way from 80 % to 10 % of the initial speed",
            Limit(_R13H, lowest=6.43) if legal else None,
            why,
        ),
        Measure(
            "deceleration.largest",
            float(deceleration[moving].max()) if moving.any() else math.nan,
            "m/s2",
            "largest deceleration above 10 % of the initial speed",
            note=why if not began else "",
        ),
        Measure(
            "deceleration.time_to_90",
            time_to_reach(time, deceleration, 0.9 * mean, onset) if began else math.nan,
            "s",
            "time from the first movement of the pedal to 90 % of the mean fully developed deceleration",
            note=why,
        ),
        *_attitude(result, first, moving),
        *_wheels(result, first, moving, developed, Limit(_R13H, highest=0.0) if legal else None, why),
        *_course(result, first),
        *_work(result, first, why),
    ]


def _attitude(result: Result, first: int, moving: NDArray[np.bool_]) -> list[Measure]:
    text = "largest pitch angle from that before braking, nose down"
    if "chassis.pitch" not in result or not moving.any():
        return [
            Measure("pitch.largest", math.nan, "rad", text, note="the car does not tell its pitch, or did not brake")
        ]
    pitch = result["chassis.pitch"]
    return [Measure("pitch.largest", float((pitch - pitch[first])[moving].max()), "rad", text)]


def _wheels(
    result: Result, first: int, moving: NDArray[np.bool_], developed: NDArray[np.bool_], limit: Limit | None, why: str
) -> list[Measure]:
    """Slip, locked wheels, loads of the axles and how much of the load is used as braking force.

    `why`: why the stop is not whole: a wheel that has not locked until then may have done so later.
    """
    slip, loads, forces = (at_wheels(result, quantity) for quantity in ("slip", "Fz", "Fx"))
    unknown = {n: f"the car does not tell wheel_FL.{n} and its like" for n in ("slip", "Fz", "Fx")}
    short = "" if moving.any() else NOT_BRAKED
    measures = []
    for axle, wheels in (("front", [0, 1]), ("rear", [2, 3])):
        # A locked wheel turns back with its carrier as the car pitches, which its slip counts.
        value = math.nan if slip is None or short else min(float(-slip[moving][:, wheels].min()), 1.0)
        text = f"largest slip of a {axle} wheel against its carrier above 10 % of the initial speed, 1: locked"
        measures.append(
            Measure(f"slip.{axle}", value, "1", text, note=short or ("" if slip is not None else unknown["slip"]))
        )
    for k, wheel in enumerate(WHEELS):
        standing = (
            None
            if slip is None or short
            else locked(slip, result["speed"], _SLOWEST_LOCKED)[:, k] & (result.time > result.time[first])
        )
        value = math.nan if standing is None or (why and not standing.any()) else duration(result.time, standing)
        note = why or ("" if slip is not None else unknown["slip"])
        measures.append(
            Measure(
                f"locked_time.{wheel}",
                value,
                "s",
                f"time for which wheel {wheel} is locked above 15 km/h",
                limit if slip is not None else None,
                note,
            )
        )
    shares = math.nan, math.nan
    note = short or ("" if loads is not None else unknown["Fz"])
    if loads is not None and not short:
        front = loads[:, :2].sum(axis=1) / loads.sum(axis=1)
        shares = float(front[first]), float(front[developed].mean()) if developed.any() else math.nan
    measures += [
        Measure(
            "front_share.before", shares[0], "1", "share of the front axle in the wheel loads before braking", note=note
        ),
        Measure(
            "front_share.braking",
            shares[1],
            "1",
            "share of the front axle in the wheel loads, mean from 80 % to 10 % of the initial speed",
            note=note,
        ),
    ]
    note = short or ("" if loads is not None and forces is not None else unknown["Fz" if loads is None else "Fx"])
    for axle, wheels in (("front", [0, 1]), ("rear", [2, 3])):
        value = math.nan
        if loads is not None and forces is not None and developed.any():
            value = float(-forces[developed][:, wheels].sum() / loads[developed][:, wheels].sum())
        text = f"mean braking force over mean load of the {axle} axle from 80 % to 10 % of the initial speed"
        measures.append(Measure(f"utilisation.{axle}", value, "1", text, note=note))
    return measures


def _course(result: Result, first: int) -> list[Measure]:
    """Where the car ends beside the line on which it was when braking began."""
    text = "distance of the place of rest from the line of travel at the first movement of the pedal, to the left"
    names = ("chassis.x", "chassis.y", "chassis.yaw")
    if not all(n in result for n in names):
        missing = next(n for n in names if n not in result)
        aside = turned = math.nan
        note = f"the car does not tell {missing}"
    else:
        x, y, yaw = (result.continuous(n) for n in names)
        heading = yaw[first]
        aside = float(-math.sin(heading) * (x[-1] - x[first]) + math.cos(heading) * (y[-1] - y[first]))
        turned, note = float(yaw[-1] - yaw[first]), ""
    return [
        Measure("deviation.lateral", aside, "m", text, note=note),
        Measure("deviation.yaw", turned, "rad", "change of the heading while braking, positive to the left", note=note),
    ]


def _work(result: Result, first: int, why: str) -> list[Measure]:
    """What the braking forces and all losses take of the kinetic energy."""
    time, speed, loads, forces = result.time, result["speed"], at_wheels(result, "Fz"), at_wheels(result, "Fx")
    share, note = math.nan, "it needs the forces Fx and Fz of all wheels"
    if loads is not None and forces is not None and loads[first].sum() > 0.0 and first < len(time) - 1:
        note = "the steering is straight: forces are taken along the car"
        per_weight = forces[first:].sum(axis=1) / loads[first].sum()
        taken = -float(trapezoid(per_weight * speed[first:], time[first:])) * 9.81
        share = taken / (0.5 * (speed[first] ** 2 - speed[-1] ** 2))
    error, missing = math.nan, [n for n in ("energy.total", *WORKS[:3]) if n not in result]
    lost = f"the car does not tell {missing[0]}" if missing else why
    if not missing and not why:
        energies = sum(result[n][-1] - result[n][first] for n in WORKS if n in result)
        change = result["energy.total"][-1] - result["energy.total"][first]
        error = float((change - energies) / result["energy.kinetic"][first])
    text = "work of the road's forces along the car over the loss of kinetic energy of its mass; air takes the rest"
    limit = None if missing else Limit("balance of energy", -0.01, 0.01)
    return [
        Measure("energy.road_share", share, "1", text, note=note),
        Measure(
            "energy.error", error, "1", "energy that no work accounts for, over the kinetic energy", limit, lost or why
        ),
    ]


def plots_of(result: Result, onset: float) -> list[Plot]:
    """Speed, deceleration, loads, slip over the time from the onset of braking."""
    time = result.time - (onset if not math.isnan(onset) else 0.0)
    shown = time >= (-0.2 if not math.isnan(onset) else 0.0)
    t, x = time[shown], "time from the first movement of the pedal, s"
    way = travelled(result.time, result["speed"])
    here = way - np.interp(0.0, time, way)
    plots = [
        Plot("Speed over way", "way, m", "speed, m/s", [Line("", here[shown], result["speed"][shown])]),
        Plot("Deceleration", x, "deceleration, m/s²", [Line("", t, deceleration_of(result)[shown])]),
    ]
    for quantity, title, label in (("Fz", "Wheel load", "load, N"), ("slip", "Longitudinal slip", "slip")):
        values = at_wheels(result, quantity)
        if values is not None:
            lines = [Line(name, t, values[shown, k]) for k, name in ((0, "front left"), (2, "rear left"))]
            plots.append(Plot(title, x, label, lines))
    if "chassis.pitch" in result:
        pitch = Line("", t, result["chassis.pitch"][shown])
        plots.append(Plot("Pitch", x, "pitch, nose down positive, rad", [pitch]))
    return plots
