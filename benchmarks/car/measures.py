"""Measures of a car for the comparison with its class: ride, wheel hop, roll, understeer, performance, brakes.

Definitions after ISO 8855 and, for the steady turn, ISO 4138 (constant speed, slowly rising steering-wheel angle).
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.car.rig import NEUTRAL, kinematics
from benchmarks.shared.pages import Row, table
from mbs import Pose, Simulation, System, compile, linearise
from mbs.analysis.linear_model import LinearModel, Mode
from mbs.elements.road import PlaneRoad
from mbs.vehicle import Car
from mbs.vehicle.environment import GRAVITY
from mbs.vehicle.kinematics import kinematics as kinematics_by_linkages

TURN_SPEED = 22.22  # m/s
TURN_STEERING = 0.10  # fraction of full steering at the end
TURN_TIME = 40.0  # s
TURN_RANGE = (0.05, 0.30)  # g, range of the linear fits over lateral acceleration
INTERVAL = 0.02  # s between updates of the inputs
STEP = 0.01  # s
HUNDRED = 100.0 / 3.6  # m/s, 100 km/h
PEDALS = (0.5, 0.6, 0.7, 0.8, 0.9, 1.0)  # positions of the brake pedal that are tried
APPLY = 0.4  # s until the pedal is applied
BODY_MODES = 5.0  # Hz: between the modes of the body and of the wheels
HOP_MODES = 25.0  # Hz: between the modes of the wheels and of the tyre carcasses


@dataclass(frozen=True)
class Measure:
    """A measure of a car."""

    name: str
    unit: str
    usual: tuple[float, float] | None
    """Usual range of small cars."""
    meaning: str
    """Definition."""


MEASURES = (
    Measure("mass", "kg", (950.0, 1500.0), "with the payloads of the file"),
    Measure("front_load", "%", (50.0, 65.0), "load of the front wheels relative to the weight"),
    Measure("bounce_frequency", "Hz", (1.0, 1.5), "slower natural motion of the body without roll, from `linearise`"),
    Measure("pitch_frequency", "Hz", (1.0, 1.7), "the faster one"),
    Measure("bounce_damping", "1", (0.2, 0.45), "its damping ratio"),
    Measure("pitch_damping", "1", (0.2, 0.45), "its damping ratio"),
    Measure("roll_frequency", "Hz", (1.2, 3.0), "natural motion of the body with roll, on ice"),
    Measure("hop_frequency_front", "Hz", (10.0, 16.0), "natural motion of the front wheels, both alike"),
    Measure("hop_frequency_rear", "Hz", (10.0, 16.0), "natural motion of the rear wheels, both alike"),
    Measure("hop_damping_front", "1", (0.15, 0.5), "its damping ratio"),
    Measure("hop_damping_rear", "1", (0.15, 0.5), "its damping ratio"),
    Measure("roll_centre_front", "mm", (20.0, 120.0), "height above the road, suspension drawn"),
    Measure("roll_centre_rear", "mm", (80.0, 250.0), "height above the road, suspension drawn"),
    Measure("roll_share_front", "%", (50.0, 75.0), "of the front axle in the suspension roll stiffness"),
    Measure("roll_gradient", "deg/g", (3.0, 6.0), "roll of the chassis over lateral acceleration, 0.05 to 0.3 g"),
    Measure(
        "understeer_gradient",
        "deg/g",
        (1.0, 4.0),
        "steering-wheel angle divided by the steering ratio, minus Ackermann's",
    ),
    Measure("sideslip_gradient", "deg/g", None, "at the rear axle's centre, at the same speed"),
    Measure(
        "turning_circle",
        "m",
        (9.5, 11.5),
        "diameter of the outer front contact centre's way at full lock, without slip",
    ),
    Measure("time_to_100", "s", (8.0, 16.0), "0 to 100 km/h at full throttle"),
    Measure("top_speed", "km/h", (125.0, 190.0), "after two minutes at full throttle"),
    Measure("deceleration", "g", (0.7, 1.1), "mean from 100 to 20 km/h at the best pedal"),
    Measure("brake_share_front", "%", (65.0, 85.0), "of the front wheels in the brake torque of that stop"),
    Measure("dive_gradient", "deg/g", (0.5, 3.0), "pitch of the chassis over deceleration in that stop"),
)


def measure(car: Car) -> dict[str, float]:
    """All `MEASURES` of a car, by name."""
    system = compile(car.model())
    return _weight(system) | _modes(car) | _axles(car) | steady_turn(car, system) | _straight(system)


def _neutral(system: System) -> dict[str, float]:
    """Parameters of `NEUTRAL` that the System has."""
    return {name: v for name, v in NEUTRAL.items() if name in {p["name"] for p in system.meta["parameters"]}}


def _weight(system: System) -> dict[str, float]:
    at_rest = Simulation(system, parameters=_neutral(system)).sensors
    loads = [at_rest[f"wheel_{w}.Fz"] for w in ("FL", "FR", "RL", "RR")]
    return {"mass": sum(loads) / GRAVITY, "front_load": 100.0 * sum(loads[:2]) / sum(loads)}


def _modes(car: Car) -> dict[str, float]:
    """Natural modes on ice, where standing tyres do not constrain the car sideways."""
    system = compile(car.model(PlaneRoad(friction=0.0)))
    # One-sided differences: the drag torque of the engine acts in one direction.
    model = linearise(Simulation(system, parameters=_neutral(system)), side=1)
    roll = model.coordinates.index("chassis.bz")
    # Sorted by roll: if the centre of mass has a lateral offset, every mode has some.
    modes = sorted(model.oscillating_modes(), key=lambda m: abs(m.shape[roll]))
    *level, rolling = [m for m in modes if m.frequency_hz < BODY_MODES]
    bounce, pitch = sorted(level, key=lambda m: m.frequency_hz)
    hop = [m for m in modes if BODY_MODES < m.frequency_hz < HOP_MODES][:2]
    front, rear = sorted(hop, key=lambda m: -_front_share(model, m))
    results = {"roll_frequency": rolling.frequency_hz}
    for name, mode in (("bounce", bounce), ("pitch", pitch)):
        results |= {f"{name}_frequency": mode.frequency_hz, f"{name}_damping": mode.damping_ratio}
    for name, mode in (("front", front), ("rear", rear)):
        results |= {f"hop_frequency_{name}": mode.frequency_hz, f"hop_damping_{name}": mode.damping_ratio}
    return results


def _front_share(model: LinearModel, mode: Mode) -> float:
    """Fraction of the front axle in the squares of a mode shape."""
    squares = {"F": 0.0, "R": 0.0}
    for name, value in zip(model.coordinates, mode.shape, strict=True):
        name_parts = name.partition(".")[0].split()
        if name_parts[-1] in ("FL", "FR", "RL", "RR") and name_parts[0] != "wheel":
            squares[name_parts[-1][0]] += abs(value) ** 2
    return squares["F"] / (squares["F"] + squares["R"])


def _axles(car: Car) -> dict[str, float]:
    k = kinematics(car)
    stiffness = k["front.roll_stiffness"], k["rear.roll_stiffness"]
    return {
        "roll_centre_front": 1e3 * k["front.roll_centre_height"],
        "roll_centre_rear": 1e3 * k["rear.roll_centre_height"],
        "roll_share_front": 100.0 * stiffness[0] / sum(stiffness),
        "steering_ratio": k["steering_ratio"],
        "turning_circle": kinematics_by_linkages(car).drawn("front")["lock_turning_circle"],
    }


def steady_turn(car: Car, system: System) -> dict[str, float]:
    """Gradients in a left turn at constant speed with slowly rising steering angle."""
    ratio = kinematics(car)["steering_ratio"]
    pedal = _speed_controller(TURN_SPEED)
    run = Simulation(system, pose=Pose(speed=TURN_SPEED))
    rows = []
    for k in range(round(TURN_TIME / INTERVAL)):
        run.set_input("throttle", pedal(run.sensors["speed"]))
        run.set_input("steering", TURN_STEERING * max(0.0, k * INTERVAL / TURN_TIME - 0.1) / 0.9)
        run.step(STEP, round(INTERVAL / STEP))
        s = run.sensors
        if s["speed"] < 0.9 * TURN_SPEED or s["speed"] * s["chassis.wz"] > 1.1 * TURN_RANGE[1] * GRAVITY:
            break
        ahead = s["chassis.vy"] - s["chassis.wz"] * (car.wheelbase + car.vehicle.reference_point[0])
        rows.append([s["speed"], s["chassis.wz"], s["steering_wheel_angle"], s["chassis.roll"], ahead])
    speed, yaw_rate, angle, roll, lateral = np.array(rows).T
    g = speed * yaw_rate / GRAVITY
    in_range = (g > TURN_RANGE[0]) & (g < TURN_RANGE[1])
    ackermann = car.wheelbase * yaw_rate / speed
    curves = {"roll_gradient": roll, "understeer_gradient": angle / ratio - ackermann}
    curves["sideslip_gradient"] = np.arctan2(lateral, speed)
    return {name: math.degrees(np.polyfit(g[in_range], curve[in_range], 1)[0]) for name, curve in curves.items()}


def _speed_controller(target: float) -> Callable[[float], float]:
    """PI controller of the throttle as a function of the speed; both speeds in m/s."""
    integral = 0.0

    def pedal(speed: float) -> float:
        nonlocal integral
        error = target - speed
        integral += INTERVAL * error
        return min(max(0.3 * error + 0.1 * integral, 0.0), 1.0)

    return pedal


def _straight(system: System) -> dict[str, float]:
    """Full throttle from rest, and the shortest stop from 100 km/h of all pedal positions."""
    run = Simulation(system)
    run.set_input("throttle", 1.0)
    to_hundred = math.inf
    for k in range(round(120.0 / INTERVAL)):
        previous_speed = run.sensors["speed"]
        run.step(STEP, round(INTERVAL / STEP))
        speed = run.sensors["speed"]
        if previous_speed < HUNDRED <= speed:
            to_hundred = INTERVAL * (k + (HUNDRED - previous_speed) / (speed - previous_speed))
    top = speed
    stops = [_stop(system, pedal) for pedal in PEDALS]
    return {"time_to_100": to_hundred, "top_speed": 3.6 * top} | max(stops, key=lambda stop: stop["deceleration"])


def _stop(system: System, pedal: float) -> dict[str, float]:
    """Stop from 100 to 20 km/h with a constant pedal."""
    run = Simulation(system, parameters=_neutral(system), pose=Pose(speed=HUNDRED))
    level, speeds, pitches, torques = run.sensors["chassis.pitch"], [HUNDRED], [], []
    while speeds[-1] > 0.2 * HUNDRED:
        run.set_input("brake", pedal * min(1.0, len(torques) * INTERVAL / APPLY))
        run.step(STEP, round(INTERVAL / STEP))
        s = run.sensors
        speeds.append(s["speed"])
        pitches.append(s["chassis.pitch"])
        torques.append([abs(s[f"wheel_{w}.brake_torque"]) for w in ("FL", "FR", "RL", "RR")])
    deceleration = (HUNDRED - speeds[-1]) / (INTERVAL * len(torques)) / GRAVITY
    settled = np.array(torques)[len(torques) // 2 :]
    return {
        "deceleration": deceleration,
        "brake_share_front": 100.0 * float(settled[:, :2].sum() / settled.sum()),
        "dive_gradient": math.degrees(float(np.mean(pitches[len(pitches) // 2 :])) - level) / deceleration,
    }


def measure_rows(measured: Mapping[str, Mapping[str, float]]) -> list[dict[str, object]]:
    """A row for each measure, a column for each car."""
    return [
        {"measure": m.name, "unit": m.unit}
        | {car: values[m.name] for car, values in measured.items()}
        | {"usual": usual_text(m), "meaning": m.meaning}
        for m in MEASURES
    ]


def measure_table(rows: Sequence[Row]) -> str:
    """Table of the page on cars."""
    cars = [key for key in rows[0] if key not in ("measure", "unit", "usual", "meaning")]
    names = (r["measure"].replace("_", " ") + ("" if r["unit"] == "1" else f", {r['unit']}") for r in rows)
    lines = [row | {"measure": name} for row, name in zip(rows, names, strict=True)]
    return table(lines, {"measure": "", **dict.fromkeys(cars, ".2f"), "usual": ""})


def usual_text(m: Measure) -> str:
    """Text of the usual range; "-" without one."""
    return "-" if m.usual is None else f"{m.usual[0]:g} to {m.usual[1]:g}"
