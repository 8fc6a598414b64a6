"""CommonRoad's multi-body car of 29 states (BMW 320i), its own functions compiled by numba and integrated by RK4.

The functions of PyPI's `commonroad-vehicle-models` are compiled as they are, with parameters as named tuples.
"""

import dataclasses
import math
import time
from collections import namedtuple
from collections.abc import Callable
from functools import cache
from types import FunctionType, ModuleType
from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray
from vehiclemodels import vehicle_dynamics_mb as multi_body
from vehiclemodels.init_mb import init_mb
from vehiclemodels.parameters_vehicle2 import parameters_vehicle2

Array = NDArray[np.float64]
# indices of states
SPEED = 3
YAW_RATE = 5
SIDE_SPEED = 10
HELPERS = ("steering_constraints", "acceleration_constraints", "vehicle_dynamics_ks_cog")


def drive(cars: int, speed: float, h: float, angles: Array) -> tuple[Array, float]:
    """Simulate several cars one after the other.

    `h`: step, s; `angles`: mean angle of the front wheels at the end of each step, rad, shape (steps,); the model takes
    its rate, which is constant in a step.

    Returns
    -------
    states : ndarray, shape (steps, 29)
        States of the last car.
    seconds : float
        Processor time without the compilation.
    """
    run, parameters = _compiled()
    start = np.array(init_mb([0.0, 0.0, 0.0, speed, 0.0, 0.0, 0.0], parameters_vehicle2()), float)
    rates = np.diff(angles, prepend=0.0) / h
    states = run(start, rates[:1], h, parameters)  # compiles
    begin = time.process_time()
    for _ in range(cars):
        states = run(start, rates, h, parameters)
    return states, time.process_time() - begin


def motion(states: Array) -> tuple[Array, Array]:
    """Yaw rate, rad/s, and speed, m/s, of states."""
    return states[:, YAW_RATE], np.hypot(states[:, SPEED], states[:, SIDE_SPEED])


@cache
def _compiled() -> tuple[Callable[..., Array], Any]:
    """The compiled integration, and the parameters of the car."""
    derivative = _derivative()

    @numba.njit
    def rate(x: Array, u: Array, p: Any) -> Array:
        return np.array(derivative(x.copy(), u, p))  # the copy: it sets negative wheel speeds in its argument to zero

    @numba.njit
    def run(start: Array, rates: Array, h: float, p: Any) -> Array:
        x, states, u = start.copy(), np.empty((len(rates), len(start))), np.zeros(2)
        for k in range(len(rates)):
            u[0] = rates[k]
            k1 = rate(x, u, p)
            k2 = rate(x + 0.5 * h * k1, u, p)
            k3 = rate(x + 0.5 * h * k2, u, p)
            k4 = rate(x + h * k3, u, p)
            x = x + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
            states[k] = x
        return states

    return run, _tuple("parameters", parameters_vehicle2())


def _derivative() -> Any:
    """The model's right-hand side, compiled with the functions that it calls."""
    source = multi_body.vehicle_dynamics_mb
    names = dict(vars(multi_body))
    for name in HELPERS:
        names[name] = _compile(names[name])
    tyre = ModuleType("tire_model")
    tyre_model = names["tireModel"]
    sign = numba.njit(tyre_model.sign)
    for name in ("formula_longitudinal", "formula_lateral", "formula_longitudinal_comb", "formula_lateral_comb"):
        function = getattr(tyre_model, name)
        setattr(tyre, name, numba.njit(FunctionType(function.__code__, {"math": math, "sign": sign}, name)))
    names["tireModel"] = tyre
    return numba.njit(FunctionType(source.__code__, names, source.__name__))


def _compile(function: Any) -> Any:
    """A function compiled together with the functions that it calls."""
    names = {k: numba.njit(v) if isinstance(v, FunctionType) else v for k, v in function.__globals__.items()}
    return numba.njit(FunctionType(function.__code__, names, function.__name__))


def _tuple(name: str, content: Any) -> Any:
    """A named tuple of the numeric attributes of a parameter object, nested as the object is."""
    results = {}
    for key in content if not dataclasses.is_dataclass(content) else [f.name for f in dataclasses.fields(content)]:
        value = getattr(content, key)
        if value is None:
            continue
        results[key] = float(value) if isinstance(value, (int, float)) else _tuple(key, value)
    return namedtuple(name, list(results))(**results)
