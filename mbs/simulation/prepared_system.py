"""A System in the kernel's memory, once for all Simulations of it."""

from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from mbs.kernel.binding import LoadedSystem
from mbs.system.system import System

_PREPARED: WeakKeyDictionary[System, tuple[LoadedSystem, dict[str, Any]]] = WeakKeyDictionary()


def prepared(system: System) -> tuple[LoadedSystem, dict[str, Any]]:
    """What all Simulations of a System share: it in the kernel's memory, and its names, which must not be changed."""
    if system not in _PREPARED:
        loaded = LoadedSystem(system.kernel_bytes())
        if system.native is not None:
            loaded.attach(system.native)
        _PREPARED[system] = loaded, system.meta
    return _PREPARED[system]


def scales_of(system: System) -> NDArray[np.float64]:
    """What turns changes of coordinates into lengths, m, shape (nq,)."""
    return np.array(prepared(system)[1].get("coordinate_lengths", [1.0] * system.nq), float)


def distance(system: System, one: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    """Largest distance of coordinates (n, nq) in parts of the length."""
    return float(np.max(np.abs(one - other) * scales_of(system), initial=0.0)) / length_of(system)


def length_of(system: System) -> float:
    """The model's length, m; 1 m in Systems written before they stored it."""
    return float(prepared(system)[1]["report"].get("length", 1.0))
