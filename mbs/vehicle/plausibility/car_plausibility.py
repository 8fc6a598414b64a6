"""Plausibility of a car file."""

import math
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any, TypeAlias

from ali3.plausibility import Mistake, Plausibility, Value
from mbs.tyre_files.tyre_plausibility import cornering_stiffness_at, magic_plausibility, tmeasy_plausibility
from mbs.vehicle.axle import Axle
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.changed_content import changed_content, value_at
from mbs.vehicle.checks.equilibrium import Rest
from mbs.vehicle.checks.masses import centre_of_mass, weighed_points
from mbs.vehicle.checks.places import chassis_points, contact_points, drawn_points, mass_centres, rigid_parts
from mbs.vehicle.drives.automatic import Automatic
from mbs.vehicle.environment import GRAVITY
from mbs.vehicle.kinematics.axle_measures import brake_fraction
from mbs.vehicle.plausibility.axle_values import CAR, DEG, axle_rates, axle_values
from mbs.vehicle.tyres.magic_formula import MagicFormula

Data: TypeAlias = "dict[str, Any]"
Remake: TypeAlias = Callable[[Data], "tuple[CarContent, Rest] | None"]
"""Makes a car of altered content of its file, and the same car at rest; None if it is not a car."""
FINAL_DRIVE = 4.0
MAX_HEIGHT = 4.0  # m, of a truck
KILOGRAMS = ("kilograms instead of newtons", GRAVITY)
POUNDS = (
    ("pounds and inches instead of N and m", 175.127),
    ("pounds and feet instead of N and m", 14.5939),
)


def car_plausibility(what: str, car: CarContent, rest: Rest, data: Data, remake: Remake) -> list[Plausibility]:
    """Plausibility of the car, then of the tyres of each axle.

    `what`: the file; `rest`: the car at rest; `data`: content of the file.
    """
    kind = car.vehicle.category or ""
    mistakes = [
        Mistake(words, frozenset(keys), partial(_altered_values, paths, correct, data, remake))
        for words, keys, paths, correct in _mistakes(car)
    ]
    plausibility = Plausibility(what, car_values(car, rest), mistakes, kind, columns=tuple(car.axles))
    return [plausibility, *(tyre_plausibility(what, a, kind) for a in car.axles.values())]


def tyre_plausibility(what: str, axle: Axle, kind: str) -> Plausibility:
    """Plausibility of the tyres of an axle, with the factors of the car file."""
    tyre = axle.tyre
    if isinstance(tyre, MagicFormula):
        prefix = f"{tyre.key('UNLOADED_RADIUS').split(' of ', 1)[1]}: "
        return magic_plausibility(what, tyre.tyre("left"), tyre.file_numbers, kind, prefix)
    return tmeasy_plausibility(what, tyre.tyre("left"), kind, f"{tyre.path}.")


def car_values(car: CarContent, rest: Rest) -> list[Value]:
    """Values of all quantities of a car."""
    rates = {name: axle_rates(car, name, rest) for name in car.axles}
    values = [*_dimension_values(car), *_mass_values(car)]
    for name in car.axles:
        values += axle_values(car, name, rest, rates[name])
    linked = [r for r in rates.values() if r is not None]
    if len(linked) == len(rates) and car.linked:
        stiffness = [r.roll_stiffness for r in linked]
        total = sum(stiffness)
        keys: dict[str, Any] = {}
        for spring in (axle.spring for axle in car.axles.values()):
            keys |= spring.given | {spring.key("factor"): spring.factor}
        values.append(Value(CAR["roll"], total / DEG, keys))
        if total > 0.0:
            lean = _mass(car) * GRAVITY * centre_of_mass(car, payloads=True)[2] / total
            values.append(Value(CAR["gradient"], lean * DEG, keys | _centre_key(car)))
            values.append(Value(CAR["split"], stiffness[0] / total, keys))
    return [*values, *_driving_values(car, rest)]


def _centre_key(car: CarContent) -> dict[str, Any]:
    """Centre of mass of the chassis by key path."""
    return {car.chassis.key("com"): list(car.chassis.com)}


def _mass(car: CarContent) -> float:
    """Mass of all parts with payloads, kg."""
    return sum(mass for mass, _ in weighed_points(car, payloads=True))


def _dimension_values(car: CarContent) -> Iterator[Value]:
    """Values of mass, wheelbase, tracks, outline and ground clearance."""
    centres = {axle.wheel.key("centre"): list(axle.wheel.centre) for axle in car.axles.values()}
    tracks = [axle.track for axle in car.axles.values()]
    yield Value(CAR["mass"], _mass(car), {car.vehicle.key("mass"): car.vehicle.mass})
    yield Value(CAR["wheelbase"], car.wheelbase, centres)
    yield Value(CAR["tracks"], tracks[1] / tracks[0], centres)
    yield Value(CAR["slender"], 0.5 * sum(tracks) / car.wheelbase, centres)
    body = car.vehicle
    yield Value(CAR["length"], body.length / car.wheelbase, {body.key("length"): body.length, **centres})
    yield Value(CAR["width"], body.width / max(tracks), {body.key("width"): body.width, **centres})
    yield from _point_values(car)
    if points := contact_points(car):
        key, lowest = min(points.items(), key=lambda item: item[1][2])
        yield Value(CAR["clearance"], lowest[2], {key.rsplit(".", 1)[0]: list(lowest)})


def _point_values(car: CarContent) -> Iterator[Value]:
    """Values of extreme points: farthest outside the outline, nearest to the front axle, least non-zero coordinate."""
    points, body = chassis_points(car), car.vehicle
    middle, sides = body.reference_point[0], (0.5 * body.length, 0.5 * body.width)
    overhangs = {
        key: max(abs(x - middle) - sides[0], abs(y) - sides[1], z - MAX_HEIGHT, -z, 0.0)
        for key, (x, y, z) in points.items()
    }
    key = max(overhangs, key=overhangs.__getitem__)
    yield Value(CAR["outline"], overhangs[key], {key: list(points[key])})
    distances = {key: abs(point[0]) or math.inf for key, point in points.items()}
    key = min(distances, key=distances.__getitem__)
    yield Value(CAR["ahead"], distances[key], {key: list(points[key])})
    points |= drawn_points(car.front) | drawn_points(car.rear) | mass_centres(car)
    smallest = {key: min((abs(c) for c in point if c), default=math.inf) for key, point in points.items()}
    key = min(smallest, key=smallest.__getitem__)
    yield Value(CAR["nearest"], smallest[key], {key: list(points[key])})


def _mass_values(car: CarContent) -> Iterator[Value]:
    """Values of the centre of mass and of the inertias."""
    x, y, height = centre_of_mass(car, payloads=True)
    track, chassis = 0.5 * sum(axle.track for axle in car.axles.values()), car.chassis
    front_fraction = (x - car.rear.wheel.centre[0]) / car.wheelbase
    yield Value(CAR["share"], front_fraction, _centre_key(car))
    yield Value(CAR["height"], height / track, _centre_key(car))
    yield Value(CAR["aside"], y / track, _centre_key(car))
    products = [abs(p) for p in chassis.products if p]
    if products:
        product_key = {chassis.key("products"): list(chassis.products)}
        yield Value(CAR["products"], min(products) / max(chassis.inertia), product_key)
    weighed = weighed_points(car, payloads=True)
    inertia = chassis.inertia[2] + sum(m * ((px - x) ** 2 + (py - y) ** 2) for m, (px, py, _) in weighed)
    before, behind = car.wheelbase * (1.0 - front_fraction), car.wheelbase * front_fraction
    key = {chassis.key("inertia"): list(chassis.inertia)}
    if before > 0.0 and behind > 0.0:
        yield Value(CAR["yaw"], inertia / _mass(car) / (before * behind), key | {chassis.key("mass"): chassis.mass})
    size = car.vehicle.width, car.vehicle.length, car.vehicle.length
    sizes = {car.vehicle.key(f): getattr(car.vehicle, f) for f in ("width", "length")}
    for axis, moment, extent in zip("xyz", chassis.inertia, size, strict=True):
        yield Value(CAR["body_radius"], math.sqrt(moment / chassis.mass) / extent, key | sizes, f"about {axis}")
    radii = {
        math.sqrt(moment / part.mass): {part.key("inertia"): list(part.inertia), part.key("mass"): part.mass}
        for part in rigid_parts(car)
        for moment in part.inertia
    }
    for of, radius in (("least", min(radii)), ("largest", max(radii))):
        yield Value(CAR["part_radius"], radius, radii[radius], of)
    yield Value(CAR["pitch_yaw"], chassis.inertia[1] / chassis.inertia[2], key)


def _driving_values(car: CarContent, rest: Rest) -> Iterator[Value]:
    """Values of tyres, steering, drive, air and brakes."""
    stiffness = {
        name: 2.0 * cornering_stiffness_at(axle.tyre.tyre("left"), rest.load[name]) for name, axle in car.axles.items()
    }
    if min(stiffness.values()) > 0.0:
        front, rear = (2.0 * rest.load[name] / stiffness[name] * DEG for name in car.axles)
        loads = {axle.tyre.key("nominal_load"): axle.tyre.nominal_load for axle in car.axles.values()}
        yield Value(CAR["understeer"], front - rear, loads | _centre_key(car))
    for name, axle in car.axles.items():
        tyre, road = axle.tyre, car.road
        of_grip = {tyre.key("grip"): tyre.grip, tyre.key("reference_friction"): tyre.reference_friction}
        of_grip |= {road.key("friction"): road.friction, road.key("friction_factor"): road.friction_factor}
        for of, select in (("least", min), ("largest", max)):
            yield Value(CAR["grip"], select(tyre.friction) * road.grip_of(tyre), of_grip, f"{name} {of}")
    steering = car.steering
    key = steering.key("front_wheel_angle_max")
    ratio = steering.wheel_angle_max / steering.front_wheel_angle_max
    turn = {steering.key(f): getattr(steering, f) for f in ("rack_per_turn",) if hasattr(steering, f)}
    yield Value(CAR["steering"], ratio, {key: steering.front_wheel_angle_max, **turn})
    drive, driven = car.drive, car.axles[car.drive.wheels]
    keys: dict[str, Any]
    if isinstance(drive, Automatic):
        ratios = [r * drive.ratio_factor for r in drive.ratios]
        keys = {drive.key("ratios"): list(drive.ratios), drive.key("ratio_factor"): drive.ratio_factor}
    else:
        ratios, keys = [drive.ratio], {drive.key("ratio"): drive.ratio}
    keys[drive.key("limit_speed")] = drive.limit_speed
    radius = driven.tyre.rolling_radius(driven.wheel.centre[2])
    for k, overall in enumerate(ratios):
        of, speed = f"{k + 1}:", 3.6 * drive.limit_speed / overall * radius
        yield Value(CAR["overall"], overall, keys, of)
        yield Value(CAR["gear_speed"], speed, keys, of)
        if k == 0 and len(ratios) > 1:
            yield Value(CAR["first_speed"], speed, keys)
        if k == len(ratios) - 1:
            yield Value(CAR["last_speed"], speed, keys)
    yield Value(CAR["power"], drive.max_power / _mass(car), {drive.key("max_power"): drive.max_power})
    ratio = drive.max_power / (drive.max_torque * drive.limit_speed)
    yield Value(CAR["torque"], ratio, {drive.key(f): getattr(drive, f) for f in ("max_power", "max_torque")})
    air = car.aerodynamics
    if air.drag_area:
        yield Value(CAR["drag"], air.drag_area, {air.key("drag_area"): air.drag_area})
    brakes, weight = car.brakes, _mass(car) * GRAVITY
    front, rear = brakes.balance / car.front.wheel.centre[2], (1.0 - brakes.balance) / car.rear.wheel.centre[2]
    yield Value(CAR["braking"], 2.0 * brakes.torque * (front + rear) / weight, {brakes.key("torque"): brakes.torque})
    yield Value(CAR["balance"], brake_fraction(car, "front"), {brakes.key("balance"): brakes.balance})


Correction: TypeAlias = Callable[..., Sequence[Any]]
"""Function of the values at key paths that returns the values without a mistake."""


def _altered_values(paths: Sequence[str], correct: Correction, data: Data, remake: Remake) -> list[Value] | None:
    """Values of the car without a mistake at key paths; None if it is not a car."""
    try:
        values = correct(*(value_at(data, path) for path in paths))
    except (LookupError, TypeError):
        return None  # the keys are missing
    altered_car = remake(changed_content(data, dict(zip(paths, values, strict=True)), "the car"))
    return None if altered_car is None else car_values(*altered_car)


def _mistakes(car: CarContent) -> Iterator[tuple[str, set[str], Sequence[str], Correction]]:
    """Yield words, keys, changed key paths and correction of common mistakes, the commonest first."""
    for name, axle in car.axles.items():
        centre, alignment = axle.wheel.key("centre"), axle.alignment
        y = [f"{name}.wheel.centre.1"]
        yield f"half the track less half of it in {centre}", {centre}, y, _scale(2.0)
        yield f"the track instead of half of it in {centre}", {centre}, y, _scale(0.5)
        for angle in ("toe", "camber"):
            keys = [alignment.key(f"{angle}_{side}") for side in ("left", "right")]
            present = [key for key in keys if getattr(alignment, key.rsplit(".", 1)[1])]
            both = " and ".join(present)
            yield f"degrees instead of radians in {both}", set(keys), present, _scale(1.0 / DEG)
            for key in present if angle == "camber" else ():
                yield f"the sign of {key}", {key}, [key], _scale(-1.0)
            yield f"the signs of {both}", set(keys), present, _scale(-1.0)
        damper, spring = axle.damper, axle.spring
        if damper.table is not None:
            key = damper.key("table")
            yield f"bump and rebound exchanged in {key}", {key}, [key], _mirror
        for key, parts in zip((*spring.given, *damper.given), ("springs", "dampers"), strict=True):
            yield from _scales(key, (f"both {parts} of the axle instead of one", 0.5))
            yield from _scales(key, (f"half of one of the {parts}", 2.0), *POUNDS, KILOGRAMS)
        key = axle.wheel.key("spin_inertia")
        yield from _scales(key, ("both wheels instead of one", 0.5), ("half of the wheel", 2.0))
        pair = [key, axle.wheel.key("diametral_inertia")]
        yield f"{' and '.join(pair)} exchanged", set(pair), pair, lambda spin, diametral: (diametral, spin)
    chassis, drive, steering = car.chassis, car.drive, car.steering
    gears, limit = drive.key("ratios" if isinstance(drive, Automatic) else "ratio"), drive.key("limit_speed")
    yield from _scales(gears, (f"ratios without a final drive, of about {FINAL_DRIVE:g},", FINAL_DRIVE))
    yield from _scales(gears, (f"the final drive, of about {FINAL_DRIVE:g}, twice", 1.0 / FINAL_DRIVE))
    yield from _scales(limit, ("rounds per minute instead of rad/s", math.pi / 30.0))
    yield from _scales(limit, ("rounds per second instead of rad/s", 2.0 * math.pi))
    yield from _scales(drive.key("max_torque"), KILOGRAMS, ("the torque of the wheels", 0.5 / FINAL_DRIVE))
    yield from _scales(drive.key("max_power"), ("horsepower instead of W", 735.5), ("kW instead of W", 1000.0))
    inertia, balance = chassis.key("inertia"), car.brakes.key("balance")
    for a, b in ((0, 2), (0, 1)):
        words = f"moments about {'xyz'[a]} and {'xyz'[b]} exchanged in {inertia}"
        pair = [f"{inertia}.{a}", f"{inertia}.{b}"]
        yield words, {inertia}, pair, lambda first, second: (second, first)
    yield from _scales(inertia, ("half of the moments", 2.0), ("pounds and feet instead of kg and m", 0.04214))
    words = f"the share of the rear wheels in {balance}"
    yield words, {balance}, [balance], lambda share: [1.0 - share]
    sides = (("the torque of one wheel instead of a side", 2.0), ("the torque of all wheels instead of a side", 0.5))
    yield from _scales(car.brakes.key("torque"), KILOGRAMS, *sides)
    angle = steering.key("front_wheel_angle_max")
    yield from _scales(angle, ("the angle from lock to lock instead of one side", 0.5))


def _scales(key: str, *mistakes: tuple[str, float]) -> Iterator[tuple[str, set[str], Sequence[str], Correction]]:
    """Mistakes in one number, each with its words and the factor that corrects it."""
    for words, factor in mistakes:
        yield f"{words} in {key}", {key}, [key], _scale(factor)


def _scale(factor: float) -> Correction:
    """Correction by a factor on numbers, lists of numbers, and the last column of tables."""

    def scaled(value: Any) -> Any:
        if not isinstance(value, list):
            return value * factor
        return [[*item[:-1], item[-1] * factor] if isinstance(item, list) else item * factor for item in value]

    return lambda *values: [scaled(value) for value in values]


def _mirror(table: list[list[float]]) -> Sequence[Any]:
    """Exchange bump and rebound of the table of a damper."""
    return [[[-v, -force] for v, force in reversed(table)]]
