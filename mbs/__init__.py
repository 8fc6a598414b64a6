"""ALi3: real-time multibody dynamics. Describe a `Model`, `compile` it to a `System`, step it."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from mbs.affine import Affine, AffineVector
from mbs.compile import compile
from mbs.model import Model, ModelError
from mbs.system import System, SystemFileError

if TYPE_CHECKING:
    from mbs.control import AccuracyWarning, Control
    from mbs.linear_model import LinearModel, linearise
    from mbs.settings import Settings
    from mbs.simulation import Pose, Simulation, SimulationError, simulate
    from mbs.trajectory import Trajectory

# what needs the compiled kernel is imported when it is first asked for
_LAZY = {
    "AccuracyWarning": "mbs.control",
    "Control": "mbs.control",
    "Pose": "mbs.simulation",
    "Settings": "mbs.settings",
    "Simulation": "mbs.simulation",
    "SimulationError": "mbs.simulation",
    "Trajectory": "mbs.trajectory",
    "LinearModel": "mbs.linear_model",
    "linearise": "mbs.linear_model",
    "simulate": "mbs.simulation",
}

__all__ = [
    "AccuracyWarning",
    "Affine",
    "AffineVector",
    "Control",
    "LinearModel",
    "Model",
    "ModelError",
    "Pose",
    "Settings",
    "Simulation",
    "SimulationError",
    "System",
    "SystemFileError",
    "Trajectory",
    "compile",
    "linearise",
    "simulate",
]


def __getattr__(name: str) -> Any:
    if name in _LAZY:
        return getattr(import_module(_LAZY[name]), name)
    raise AttributeError(f"module 'mbs' has no attribute {name!r}")
