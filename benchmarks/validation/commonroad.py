"""Cars by CommonRoad's parameters against its own multi-body model.

The references are made by `commonroad_reference`. Both are asked for the same angle of the front wheels and the same
torque of the brakes; engine and air are left out here, as that model has none.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.validation.commonroad_reference import (
    BEGIN,
    BRAKING,
    FOLDER,
    MANOEUVRES,
    SECONDS,
    STEER,
    STEER_SPEED,
)
from hosts.common.wheels import WHEELS
from mbs import Pose, compile, simulate
from mbs.vehicle import Car, load

Array = NDArray[np.float64]

STEP = 0.002
ROLLING = 0.344  # m, R_w
SAME = {"steering.frequency": 200.0, "ports.torque": "half_shafts"}
"""Of the cars here: their wheels follow the demand at once, and nothing drives or drags."""


@dataclass(frozen=True)
class Compared:
    """A manoeuvre of both models, at the times of the reference."""

    reference: Mapping[str, Array]
    found: Mapping[str, Array]
    """`reference`, `found`, each of shape (n,): by the names of the reference's columns."""


def compared(name: str, manoeuvre: str) -> Compared:
    """Drive a car as its reference was driven. `manoeuvre`: of `MANOEUVRES`."""
    table = np.genfromtxt(FOLDER / f"{name}_{manoeuvre}.csv", delimiter=",", names=True)
    table = table[table["time"] > BEGIN - 0.1]
    reference = {column: np.asarray(table[column]) for column in table.dtype.names}
    car = load(name)
    changes = _consistent(car) if manoeuvre.startswith("consistent") else {}
    car = car.changed(SAME | changes)
    run = simulate(
        compile(car.model()), SECONDS, STEP, inputs=_inputs(car, manoeuvre), pose=Pose(speed=MANOEUVRES[manoeuvre])
    )
    names = {"vx": "chassis.vx", "yaw_rate": "chassis.wz", "roll": "chassis.roll", "pitch": "chassis.pitch"}
    names |= {"x": "chassis.x", "y": "chassis.y"} | {f"Fz_{wheel}": f"wheel_{wheel}.Fz" for wheel in WHEELS}
    results = {ours: np.interp(reference["time"], run.t, run[theirs]) for ours, theirs in names.items()}
    for axis in ("x", "y"):
        reference[axis], results[axis] = reference[axis] - reference[axis][0], results[axis] - results[axis][0]
    return Compared(reference, results)


def _consistent(car: Car) -> dict[str, Any]:
    """The wheels' carriers as heavy as `commonroad_reference.consistent` has the axles."""
    sprung = -car.chassis.com[0]
    axles = {"front": car.wheelbase - sprung, "rear": sprung}
    parts = {axle: getattr(car, axle) for axle in axles}
    carried = {axle: part.suspension.bodies.carrier.mass for axle, part in parts.items()}
    half = sum(carried[axle] + part.wheel.mass for axle, part in parts.items())
    return {
        f"{axle}.suspension.bodies.carrier.mass": half * lever / car.wheelbase - parts[axle].wheel.mass
        for axle, lever in axles.items()
    }


def _inputs(car: Car, manoeuvre: str) -> dict[str, tuple[Array, Array]]:
    """Of both models the same."""
    if manoeuvre != "braking":
        most = car.steering.front_wheel_angle_max
        t = np.array([0.0, BEGIN, BEGIN + STEER / STEER_SPEED, SECONDS])
        return {"steering": (t, np.array([0.0, 0.0, STEER, STEER]) / most)}
    pedal = car.vehicle.mass * ROLLING * BRAKING / (2.0 * car.brakes.torque)
    t = np.array([0.0, BEGIN, BEGIN + 1e-6, SECONDS])
    return {"brake": (t, np.array([0.0, 0.0, pedal, pedal]))}
