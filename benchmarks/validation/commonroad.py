"""Cars by CommonRoad's parameters against its own multi-body model.

`commonroad_reference` writes the references. Both have the same angle of the front wheels and the same brake torque;
engine and air are left out here, since that model has none.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.validation.commonroad_reference import BEGIN, BRAKING, FOLDER, MANOEUVRES, SECONDS, STEER, STEER_SPEED
from hosts.common.wheels import WHEELS
from mbs import Pose, compile, simulate
from mbs.vehicle import Car, load

Array = NDArray[np.float64]

STEP = 0.002  # s
ROLLING_RADIUS = 0.344  # m, R_w of that model
COMMON_CHANGES = {"steering.frequency": 200.0, "ports.torque": "half_shafts"}
"""Changes of the cars here, as that model has them: fast steering, and no torque of drive and engine drag."""


@dataclass(frozen=True)
class Comparison:
    """A manoeuvre of both models, at the times of the reference."""

    reference: Mapping[str, Array]
    """Values by column of the reference, each of shape (n,)."""
    simulated: Mapping[str, Array]
    """Values of the car here by column of the reference, each of shape (n,)."""


def compare(name: str, manoeuvre: str) -> Comparison:
    """Simulate a car in the manoeuvre of its reference. `manoeuvre`: one of `MANOEUVRES`."""
    table = np.genfromtxt(FOLDER / f"{name}_{manoeuvre}.csv", delimiter=",", names=True)
    table = table[table["time"] > BEGIN - 0.1]
    reference = {column: np.asarray(table[column]) for column in table.dtype.names}
    car = load(name)
    changes = _consistent(car) if manoeuvre.startswith("consistent") else {}
    car = car.changed(COMMON_CHANGES | changes)
    run = simulate(
        compile(car.model()), SECONDS, STEP, inputs=_inputs(car, manoeuvre), pose=Pose(speed=MANOEUVRES[manoeuvre])
    )
    names = {"vx": "chassis.vx", "yaw_rate": "chassis.wz", "roll": "chassis.roll", "pitch": "chassis.pitch"}
    names |= {"x": "chassis.x", "y": "chassis.y"} | {f"Fz_{wheel}": f"wheel_{wheel}.Fz" for wheel in WHEELS}
    results = {column: np.interp(reference["time"], run.t, run[sensor]) for column, sensor in names.items()}
    for axis in ("x", "y"):
        reference[axis], results[axis] = reference[axis] - reference[axis][0], results[axis] - results[axis][0]
    return Comparison(reference, results)


def _consistent(car: Car) -> dict[str, Any]:
    """Masses of the wheel carriers that give the axle masses of `commonroad_reference.consistent`."""
    sprung = -car.chassis.com[0]
    axles = {"front": car.wheelbase - sprung, "rear": sprung}
    axle_data = {axle: getattr(car, axle) for axle in axles}
    carriers = {axle: data.suspension.bodies.carrier.mass for axle, data in axle_data.items()}
    half = sum(carriers[axle] + data.wheel.mass for axle, data in axle_data.items())
    return {
        f"{axle}.suspension.bodies.carrier.mass": half * lever / car.wheelbase - axle_data[axle].wheel.mass
        for axle, lever in axles.items()
    }


def _inputs(car: Car, manoeuvre: str) -> dict[str, tuple[Array, Array]]:
    """Inputs of both models in a manoeuvre."""
    if manoeuvre != "braking":
        most = car.steering.front_wheel_angle_max
        t = np.array([0.0, BEGIN, BEGIN + STEER / STEER_SPEED, SECONDS])
        return {"steering": (t, np.array([0.0, 0.0, STEER, STEER]) / most)}
    pedal = car.vehicle.mass * ROLLING_RADIUS * BRAKING / (2.0 * car.brakes.torque)
    t = np.array([0.0, BEGIN, BEGIN + 1e-6, SECONDS])
    return {"brake": (t, np.array([0.0, 0.0, pedal, pedal]))}
