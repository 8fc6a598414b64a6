"""Rates of sensors as the kernel gives them, beside differences over a small step."""

import ctypes

import numpy as np
from numpy.typing import NDArray

from mbs.kernel.binding.instance import Instance

RATE_ERROR = 2e-3
Array = NDArray[np.float64]


def rates_of(instance: Instance) -> tuple[Array, NDArray[np.bool_]]:
    """Rates of all sensors, and which of them are known."""
    ns = instance.system.sizes.ns
    rates, known = (ctypes.c_double * ns)(), ctypes.create_string_buffer(ns)
    assert instance._library.ali3_sensor_rates(instance._handle, rates, known) == 0
    return np.array(rates[:]), np.frombuffer(known.raw[:ns], dtype=np.uint8) == 1


def slopes_of(instance: Instance, step: float = 1e-5) -> Array:
    """Changes of all sensors over the next step, by its length."""
    first = np.array(instance.sensors()[:])
    instance.step(step)
    return np.asarray((np.array(instance.sensors()[:]) - first) / step)
