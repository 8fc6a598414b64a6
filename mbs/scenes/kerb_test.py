"""The paper's test (section 4): the prototype car rolls from rest to 5 m/s, down a kerb of 8 cm, and to rest, in 15 s.

The forward motion of the chassis is prescribed in time; the paper prescribes the measured one. Kerb, duration, top
speed and the three intervals are the paper's; the times within them and the position of the kerb are assumed.
"""

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.polynomial import Polynomial
from scipy.interpolate import PPoly

from mbs.elements.road import KerbRoad
from mbs.model.model import Model
from mbs.model.records import DrivingFunction
from mbs.scenes import prototype_car
from mbs.vehicle import Car
from mbs.vehicle.fidelity import OFFERED, Fidelity

SPEED = 5.0  # m/s
ACCELERATE = (5.0, 7.4)  # s: start and end
BRAKE = (8.2, 10.0)  # s; between both intervals the speed is constant
DURATION = 15.0  # s
STEP = 0.01  # s
EDGE = 7.5  # m from the front axle at rest to the kerb; front wheels pass it at 7.70 s, rear wheels at 8.16 s
HEIGHT = 0.08  # m, of the kerb
PIECE = 0.1  # s, length of a polynomial piece of the driving function
_SMOOTH_STEP = Polynomial([0.0, 0.0, 0.0, 10.0, -15.0, 6.0])
"""Step from 0 to 1 on the interval 0 to 1, with first and second derivatives of zero at both ends."""


def build(
    fidelity: Fidelity | int | str = Fidelity.DYNAMIC,
    car: Car | None = None,
    guide: Callable[[Model, float], DrivingFunction] | None = None,
) -> Model:
    """Model of the car in equilibrium in front of the kerb.

    Parameters
    ----------
    fidelity : Fidelity, int or str
        How much of the chassis is modelled, as in `prototype_car.build`.
    car : Car, optional
        By default the prototype.
    guide : callable, optional
        Makes the driving function of x of the chassis' reference point from its value at the start, m; by default
        `smooth_driving_function`.
    """
    make_driving_function = smooth_driving_function if guide is None else guide
    test_car = prototype_car.car() if car is None else car
    road = KerbRoad(EDGE, HEIGHT, -HEIGHT, "before", test_car.road.friction)
    m = test_car.model(road, fidelity, lambda model: make_driving_function(model, test_car.chassis.reference[0]))
    m.stop_time, m.step = DURATION, STEP
    return m


def fidelities() -> dict[Fidelity, Callable[[], Model]]:
    """Builders of the models that an FMU offers by its parameter `fidelity`."""
    return {fidelity: partial(build, fidelity) for fidelity in OFFERED}


def speed(t: float | np.ndarray) -> np.ndarray:
    """Prescribed speed of the chassis at times in s, m/s."""
    up, down = (np.clip((np.asarray(t) - a) / (b - a), 0.0, 1.0) for a, b in (ACCELERATE, BRAKE))
    return np.asarray(SPEED * (_SMOOTH_STEP(up) - _SMOOTH_STEP(down)))


def distance(t: float | np.ndarray) -> np.ndarray:
    """Prescribed distance from rest at times in s, m: the integral of `speed`."""
    integral = _SMOOTH_STEP.integ()
    total = np.zeros(np.shape(t))
    for sign, (a, b) in ((1.0, ACCELERATE), (-1.0, BRAKE)):
        u = (np.asarray(t) - a) / (b - a)
        total += sign * SPEED * (b - a) * (integral(np.clip(u, 0.0, 1.0)) + np.maximum(u - 1.0, 0.0))
    return total


def smooth_driving_function(m: Model, start: float) -> DrivingFunction:
    """Prescribe x of a chassis point by polynomials of degree 5 that interpolate `distance` and two derivatives.

    `start`: x at rest, m.
    """
    breaks = np.concatenate(
        [[0.0], *(np.arange(a, b + 0.5 * PIECE, PIECE) for a, b in (ACCELERATE, BRAKE)), [DURATION]]
    )
    v, acceleration = speed(breaks), _acceleration(breaks)
    x = start + distance(breaks)
    coefficients = []
    for k, h in enumerate(np.diff(breaks)):
        low_coefficients = [x[k], v[k], acceleration[k] / 2.0]
        A = np.array(
            [
                [h**n for n in (3, 4, 5)],
                [n * h ** (n - 1) for n in (3, 4, 5)],
                [n * (n - 1) * h ** (n - 2) for n in (3, 4, 5)],
            ]
        )
        residual = np.array(
            [
                x[k + 1] - low_coefficients[0] - low_coefficients[1] * h - low_coefficients[2] * h * h,
                v[k + 1] - low_coefficients[1] - 2 * low_coefficients[2] * h,
                acceleration[k + 1] - 2 * low_coefficients[2],
            ]
        )
        coefficients.append([*low_coefficients, *np.linalg.solve(A, residual)])
    motion = PPoly(np.array(coefficients).T[::-1], breaks)
    return m.guide_time("way of the chassis", motion, unit="m")


def _acceleration(t: np.ndarray) -> np.ndarray:
    """Prescribed acceleration at times in s, m/s2."""
    slope = _SMOOTH_STEP.deriv()
    slopes = [slope(np.clip((t - a) / (b - a), 0.0, 1.0)) / (b - a) for a, b in (ACCELERATE, BRAKE)]
    return np.asarray(SPEED * (slopes[0] - slopes[1]))
