"""ALi3: real-time multibody dynamics. Describe a `Model`, `compile` it to a `System`, step it."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from mbs.affine import Affine, AffineVector
from mbs.branch_warning import BranchWarning
from mbs.compiler import compile
from mbs.errors import ArgumentTypeError
from mbs.lazy_modules import lazy_modules
from mbs.model import Model, ModelError
from mbs.system import System, SystemFileError

if TYPE_CHECKING:
    from mbs import elements as elements
    from mbs import flexible as flexible
    from mbs import roads as roads
    from mbs import scenes as scenes
    from mbs import shapes as shapes
    from mbs import vehicle as vehicle
    from mbs.accuracy import Accuracy, AccuracyWarning
    from mbs.animation import Animation, animate
    from mbs.control import Control
    from mbs.kinks import LinearisationWarning
    from mbs.large_bending import BendingWarning
    from mbs.linear_model import LinearModel, linearise
    from mbs.periodic_motion import FloquetModel, floquet
    from mbs.poses import Poses
    from mbs.roads import RoadFile, RoadFileError, RoadWarning, read_road, write_road
    from mbs.settings import Settings
    from mbs.simulation import Pose, Simulation, simulate
    from mbs.simulation_error import SimulationError
    from mbs.trajectory import Trajectory

# packages of their own, imported when they are first asked for: mbs.vehicle.load("prototype")
_package = lazy_modules("mbs", ("elements", "flexible", "roads", "scenes", "shapes", "vehicle"))
# what needs the compiled kernel is imported when it is first asked for
_LAZY = {
    "Accuracy": "mbs.accuracy",
    "AccuracyWarning": "mbs.accuracy",
    "Animation": "mbs.animation",
    "animate": "mbs.animation",
    "Control": "mbs.control",
    "Poses": "mbs.poses",
    "Pose": "mbs.simulation",
    "RoadFile": "mbs.roads",
    "RoadFileError": "mbs.roads",
    "RoadWarning": "mbs.roads",
    "read_road": "mbs.roads",
    "write_road": "mbs.roads",
    "Settings": "mbs.settings",
    "Simulation": "mbs.simulation",
    "SimulationError": "mbs.simulation_error",
    "Trajectory": "mbs.trajectory",
    "FloquetModel": "mbs.periodic_motion",
    "BendingWarning": "mbs.large_bending",
    "LinearModel": "mbs.linear_model",
    "LinearisationWarning": "mbs.kinks",
    "floquet": "mbs.periodic_motion",
    "linearise": "mbs.linear_model",
    "simulate": "mbs.simulation",
}

__all__ = [
    "Accuracy",
    "AccuracyWarning",
    "Affine",
    "AffineVector",
    "Animation",
    "ArgumentTypeError",
    "Control",
    "BendingWarning",
    "BranchWarning",
    "FloquetModel",
    "LinearModel",
    "LinearisationWarning",
    "Model",
    "ModelError",
    "Pose",
    "Poses",
    "RoadFile",
    "RoadFileError",
    "RoadWarning",
    "Settings",
    "Simulation",
    "SimulationError",
    "System",
    "SystemFileError",
    "Trajectory",
    "animate",
    "compile",
    "floquet",
    "linearise",
    "read_road",
    "simulate",
    "write_road",
]


def __getattr__(name: str) -> Any:
    if name in _LAZY:
        return getattr(import_module(_LAZY[name]), name)
    return _package(name)
