"""A System in the kernel's memory, once for all Simulations of it."""

from __future__ import annotations

from typing import Any
from weakref import WeakKeyDictionary

from mbs.kernel.binding import LoadedSystem
from mbs.system.system import System

_PREPARED: WeakKeyDictionary[System, tuple[LoadedSystem, dict[str, Any]]] = WeakKeyDictionary()


def prepared(system: System) -> tuple[LoadedSystem, dict[str, Any]]:
    """What all Simulations of a System share: it in the kernel's memory, and its names, which must not be changed."""
    if system not in _PREPARED:
        _PREPARED[system] = LoadedSystem(system.kernel_bytes()), system.meta
    return _PREPARED[system]


def length_of(system: System) -> float:
    """The model's length, m; 1 m in Systems written before they stored it."""
    return float(prepared(system)[1]["report"].get("length", 1.0))
