"""Systems with changed arrays, for tests of a loader."""

from collections.abc import Callable

import numpy as np

from mbs.system.system import System

Change = Callable[[np.ndarray], np.ndarray]


def put(index: int, value: float) -> Change:
    """Function that sets one element of an array."""

    def change(values: np.ndarray) -> np.ndarray:
        values[index] = value
        return values

    return change


def altered(system: System, **changes: Change) -> bytes:
    """Bytes of a System with changed arrays. `changes`: functions of arrays by name."""
    arrays = {name: np.array(values) for name, values in system.arrays.items()}
    for name, change in changes.items():
        arrays[name] = change(arrays[name])
    return System(arrays, system.meta).to_bytes()
