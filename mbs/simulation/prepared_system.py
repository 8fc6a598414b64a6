"""System in the kernel's memory, loaded once for all its Simulations."""

from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from mbs.kernel.binding import LoadedSystem
from mbs.system.system import System


class PreparedSystem(NamedTuple):
    """System in the kernel's memory and its metadata, shared by all its Simulations, so neither may be changed."""

    loaded: LoadedSystem
    meta: dict[str, Any]


_PREPARED: WeakKeyDictionary[System, PreparedSystem] = WeakKeyDictionary()


def prepared(system: System) -> PreparedSystem:
    """The System in the kernel's memory, loaded at the first call."""
    if system not in _PREPARED:
        loaded = LoadedSystem(system.kernel_bytes())
        if system.native is not None:
            loaded.attach(system.native)
        _PREPARED[system] = PreparedSystem(loaded, system.meta)
    return _PREPARED[system]


def scales_of(system: System) -> NDArray[np.float64]:
    """Displacement of a unit change of each coordinate, m, shape (nq,)."""
    return np.array(prepared(system).meta.get("coordinate_lengths", [1.0] * system.nq), float)


def distance(system: System, one: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    """Largest difference of two sets of coordinates, each (n, nq), relative to the model's length."""
    return float(np.max(np.abs(one - other) * scales_of(system), initial=0.0)) / length_of(system)


def length_of(system: System) -> float:
    """The model's characteristic length, m; 1 m if the System does not state it."""
    return float(prepared(system).meta["report"].get("length", 1.0))
