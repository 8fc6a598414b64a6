"""Other engines on the shared scenes (extra `peers`), each with its fastest settings of equal accuracy."""

import importlib
import importlib.util
import sys
from types import ModuleType

NAMES = {
    "drake": "benchmarks.peers.drake_peer",
    "exudyn": "benchmarks.peers.exudyn_peer",
    "mujoco": "benchmarks.peers.mujoco_peer",
    "pinocchio": "benchmarks.peers.pinocchio_peer",
}
PACKAGES = {"drake": "pydrake"}  # modules of another name

sys.exudynFast = True  # type: ignore[attr-defined] # Exudyn's faster module, asked for before it is imported


def available() -> tuple[dict[str, ModuleType], list[str]]:
    """Modules of the installed engines by name, and the names of the engines that are not installed."""
    missing = [n for n in NAMES if importlib.util.find_spec(PACKAGES.get(n, n)) is None]
    return {n: importlib.import_module(m) for n, m in NAMES.items() if n not in missing}, missing
