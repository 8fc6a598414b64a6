"""Plausibility values of an axle of a car file."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ali3.plausibility import Value, quantities_of
from mbs.vehicle.axle import Axle
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.checks.equilibrium import Rest
from mbs.vehicle.checks.places import drawn_points, mass_centres
from mbs.vehicle.checks.working_ranges import DAMPER_SPEED, compression_and_slope, weight_on_spring
from mbs.vehicle.environment import GRAVITY
from mbs.vehicle.kinematics.axle_measures import roll_measures, travel_measures, wheel_measures
from mbs.vehicle.linkages.continuation import HEAVE
from mbs.vehicle.linkages.linkage import Linkage, NotReachedError
from mbs.vehicle.suspensions.curves import Curves

CAR = quantities_of("car")
DEG = 180.0 / math.pi
MIN_ABSOLUTE_Y = 0.1  # m: a larger y of a table is measured from the middle plane


@dataclass(frozen=True)
class AxleRates:
    """Rates of springs and dampers at the wheels of an axle."""

    wheel_rate: float
    """Wheel rate of one wheel, N/m."""
    damper_ratio: float
    """Travel of the damper per travel of the wheel."""
    roll_stiffness: float
    """Roll stiffness of the axle, N m/rad."""
    steering_axis: dict[str, float]
    """Caster angle and kingpin inclination, rad, and kingpin offset, m, of a steered axle with links."""


def axle_rates(car: CarContent, name: str, rest: Rest) -> AxleRates | None:
    """Rates of an axle by its links as drawn, or without links by virtual work at rest; None without spring force.

    `name`: "front" or "rear".
    """
    axle = car.axles[name]
    if axle.suspension.linked:
        try:
            linkage = Linkage(car, name)
            at = linkage.drawn
            travel, wheel = travel_measures(linkage, at, HEAVE), wheel_measures(linkage, at)
            roll = roll_measures(linkage, at)["roll_stiffness"]
        except (NotReachedError, ValueError):
            return None
        names = ("caster_angle", "kingpin_inclination_angle", "kingpin_offset_at_ground")
        axis = {n: wheel[f"{n}_left"] for n in names if name == "front" and f"{n}_left" in wheel}
        return AxleRates(travel["wheel_rate_left"], travel["damper_ratio_left"], roll, axis)
    carried, force = weight_on_spring(axle, rest.load[name]), abs(rest.spring_force[name])
    if force < 1.0 or carried <= 0.0:
        return None
    ratio = carried / force
    rate = compression_and_slope(axle.spring, force)[1] * axle.spring.factor * ratio**2
    return AxleRates(rate, ratio, 0.5 * rate * axle.track**2, {})


def axle_values(car: CarContent, name: str, rest: Rest, rates: AxleRates | None) -> Iterator[Value]:
    """Values of an axle. `name`: "front" or "rear"; `rates`: result of `axle_rates`."""
    axle, centre = car.axles[name], car.axles[name].wheel.centre
    centre_key = {axle.wheel.key("centre"): list(centre)}
    yield Value(CAR["track"], axle.track, centre_key, name)
    for key, point in drawn_points(axle).items():
        if key.endswith("ball_joint"):
            of = f"{name} {key.rsplit('.', 1)[1].removesuffix('_ball_joint')}"
            distance = math.hypot(point[0] - centre[0], point[2] - centre[2])
            yield Value(CAR["joint"], centre[1] - point[1], {key: list(point), **centre_key}, of)
            yield Value(CAR["joint_radius"], distance / axle.tyre.radius, {key: list(point), **centre_key}, of)
    yield from _distance_values(axle, name)
    yield from _alignment_values(axle, name)
    yield Value(
        CAR["wheel_radius"],
        math.sqrt(axle.wheel.spin_inertia / axle.wheel.mass) / axle.tyre.radius,
        {axle.wheel.key("spin_inertia"): axle.wheel.spin_inertia, axle.wheel.key("mass"): axle.wheel.mass},
        name,
    )
    moments = {axle.wheel.key(f): getattr(axle.wheel, f) for f in ("diametral_inertia", "spin_inertia")}
    yield Value(CAR["wheel_moments"], axle.wheel.diametral_inertia / axle.wheel.spin_inertia, moments, name)
    nominal = axle.tyre.nominal_load
    yield Value(CAR["loaded"], rest.load[name] / nominal, {axle.tyre.key("nominal_load"): nominal}, name)
    if isinstance(axle.suspension, Curves):
        yield from _curve_values(axle.suspension, name, centre_key)
    if rates is not None:
        for quantity, angle in (("caster", "caster_angle"), ("kingpin", "kingpin_inclination_angle")):
            if angle in rates.steering_axis:
                yield Value(CAR[quantity], rates.steering_axis[angle] * DEG, _axis_points(axle), name)
        if (scrub := rates.steering_axis.get("kingpin_offset_at_ground")) is not None:
            yield Value(CAR["scrub"], scrub, {**centre_key, **_axis_points(axle)}, name)
        yield from _spring_values(axle, name, rest, rates)


def _distance_values(axle: Axle, name: str) -> Iterator[Value]:
    """Values of the distances of the farthest points and parts of an axle."""
    points, centre, parts = drawn_points(axle), axle.wheel.centre, mass_centres(axle)
    if not axle.suspension.linked:
        points = parts
    hub_keys = {axle.suspension.points.key(n) for n in axle.suspension.near_wheel} if axle.suspension.linked else set()
    for quantity, keys in (("carrier", points.keys() & hub_keys), ("reach", points.keys() - hub_keys)):
        if keys:
            key = max(sorted(keys), key=lambda k: math.dist(points[k], centre))
            yield Value(CAR[quantity], math.dist(points[key], centre), {key: list(points[key])}, name)
    box_points = np.array([*points.values(), centre])
    overhangs = {
        key: float(max((box_points.min(axis=0) - com).max(), (com - box_points.max(axis=0)).max(), 0.0))
        for key, com in parts.items()
    }
    if overhangs and axle.suspension.linked:
        key = max(overhangs, key=overhangs.__getitem__)
        yield Value(CAR["part"], overhangs[key], {key: list(parts[key])}, name)


def _axis_points(axle: Axle) -> dict[str, Any]:
    """Points of the steering axis by key path."""
    return {key: list(p) for key, p in drawn_points(axle).items() if key.endswith(("ball_joint", "strut_top"))}


def _alignment_values(axle: Axle, name: str) -> Iterator[Value]:
    """Values of toe and camber."""
    a = axle.alignment
    toe = {a.key(f"toe_{side}"): getattr(a, f"toe_{side}") for side in ("left", "right")}
    camber = {a.key(f"camber_{side}"): getattr(a, f"camber_{side}") for side in ("left", "right")}
    yield Value(CAR["toe"], sum(toe.values()) * DEG, toe, name)
    for side, (key, value) in zip(("left", "right"), camber.items(), strict=True):
        yield Value(CAR["camber"], value * DEG, {key: value}, f"{name} {side}")
    yield Value(CAR["cambers"], (a.camber_left - a.camber_right) * DEG, camber, name)


def _spring_values(axle: Axle, name: str, rest: Rest, rates: AxleRates) -> Iterator[Value]:
    """Values of springs and dampers at the wheels."""
    mass, rate = weight_on_spring(axle, rest.load[name]) / GRAVITY, rates.wheel_rate
    spring, damper = axle.spring, axle.damper
    springs = spring.given | {spring.key("factor"): spring.factor}
    yield Value(CAR["rate"], rate * 1e-3, springs, name)
    free = spring.free_length
    yield Value(CAR["pressed"], rest.spring_length[name] / free, {spring.key("free_length"): free, **springs}, name)
    if mass <= 0.0 or rate <= 0.0:
        return
    yield Value(CAR["bounce"], math.sqrt(rate / mass) / (2.0 * math.pi), springs, name)
    dampers = damper.given | {damper.key("factor"): damper.factor}
    bump, rebound = (damper.factor * damper.coefficient_at(speed) for speed in (-DAMPER_SPEED, DAMPER_SPEED))
    critical = 2.0 * math.sqrt(rate * mass)
    for quantity, damping in (("bump", bump), ("rebound", rebound)):
        yield Value(CAR[quantity], damping * rates.damper_ratio**2 / critical, dampers, name)
    if bump > 0.0:
        yield Value(CAR["sides"], rebound / bump, damper.given, name)


def _curve_values(curves: Curves, name: str, centre: dict[str, Any]) -> Iterator[Value]:
    """Values of the table of an axle given by curves."""
    table, key = curves.table, {curves.key("file"): curves.file}
    i, k = table.drawn
    (wheel,) = centre.values()
    for column in ("wheel_centre_y", "contact_centre_y"):
        values = table.of(column, "left")
        if values is not None and abs(values[i, k]) > MIN_ABSOLUTE_Y:
            yield Value(CAR["curve_place"], float(values[i, k]) / wheel[1], {**key, **centre}, name)
            break
    for quantity, columns in (
        ("curve_camber", ("camber_angle", "inclination_angle")),
        ("curve_toe", ("toe_angle", "steer_angle")),
    ):
        for column, sign in zip(columns, (1.0, -1.0), strict=True):
            values = table.of(column, "left")
            if values is not None:
                slope = np.gradient(values[:, k], table.travel)[i] * DEG
                yield Value(CAR[quantity], sign * float(slope), key, name)
                break
