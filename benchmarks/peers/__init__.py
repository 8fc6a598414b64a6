"""Other engines on the shared scenes, when they are installed (extra `peers`); each with its fastest fair settings."""

from __future__ import annotations

import importlib
import importlib.util
from types import ModuleType

NAMES = {
    "exudyn": "benchmarks.peers.exudyn_peer",
    "mujoco": "benchmarks.peers.mujoco_peer",
    "pinocchio": "benchmarks.peers.pinocchio_peer",
}


def available() -> tuple[dict[str, ModuleType], list[str]]:
    """Modules of the engines that are installed, by engine, and the names of those that are not."""
    found = {n: importlib.import_module(m) for n, m in NAMES.items() if importlib.util.find_spec(n) is not None}
    return found, [n for n in NAMES if n not in found]
