"""The steering ratio of a car near straight ahead, measured in a slow drive."""

import math

import numpy as np
from scipy import stats

from hosts.catalogue.car import TestedCar
from hosts.catalogue.preparation import start_at_speed
from hosts.catalogue.steering import SteeringInput
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.pilots.combined_pilot import CombinedPilot
from hosts.driving.pilots.speed_holder import SpeedHolder
from hosts.driving.pilots.steering_table import SteeringTable

RATIO = "vehicle.steering_ratio"
WHEELS = ("wheel_FL.steer", "wheel_FR.steer")
_SPEED = 3.0
_ANGLE = math.radians(30.0)


def steering_ratio(car: TestedCar) -> float:
    """Ratio of the angle of the steering wheel and the mean angle of the front wheels; NaN if unknown.

    If the car reports the angles of its wheels, by a regression while the steering wheel turns to 30° to both sides at
    3 m/s; otherwise the constant of the car.
    """
    if any(name not in car.facts.outputs for name in WHEELS):
        return car.facts.constants.get(RATIO, math.nan)
    steering = SteeringInput.of(car.facts)
    if not steering.is_angle:
        return car.facts.constants.get(RATIO, math.nan)
    times = np.array([0.0, 1.0, 3.0, 7.0])
    table = steering.per_radian * _ANGLE * np.array([0.0, 0.0, 1.0, -1.0])
    pilot = CombinedPilot(
        SpeedHolder(_SPEED, brakes="brake" in car.facts.inputs), SteeringTable(times, table, steering.name)
    )
    result = car.drive(
        Manoeuvre("steering ratio", np.zeros(0), {}, 7.0, start_at_speed(car, _SPEED)), pilot, record_step=0.02
    )
    wheels = 0.5 * (result[WHEELS[0]] + result[WHEELS[1]])
    rows = result.time > 1.0
    if rows.sum() < 10 or not np.ptp(wheels[rows]) > 1e-3:
        return car.facts.constants.get(RATIO, math.nan)
    return 1.0 / float(stats.linregress(steering.measured_angle(result, car.facts.step)[rows], wheels[rows]).slope)
