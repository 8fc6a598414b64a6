"""Systems with one array changed, for what a loader must refuse."""

from collections.abc import Callable

import numpy as np

from mbs.system.system import System

Change = Callable[[np.ndarray], np.ndarray]


def put(index: int, value: float) -> Change:
    """Another value at one place."""

    def change(values: np.ndarray) -> np.ndarray:
        values[index] = value
        return values

    return change


def altered(system: System, **changes: Change) -> bytes:
    """The file of a System some of whose arrays are changed."""
    arrays = {name: np.array(values) for name, values in system.arrays.items()}
    for name, change in changes.items():
        arrays[name] = change(arrays[name])
    return System(arrays, system.meta).to_bytes()
