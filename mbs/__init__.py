"""ALi3: real-time multibody dynamics. Describe a `Model`, `compile` it to a `System`, step it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mbs.common.lazy_modules import lazy_modules

if TYPE_CHECKING:
    from mbs import elements as elements
    from mbs import flexible as flexible
    from mbs import roads as roads
    from mbs import scenes as scenes
    from mbs import shapes as shapes
    from mbs import vehicle as vehicle
    from mbs.analysis.kinks import LinearisationWarning
    from mbs.analysis.linear_model import LinearModel, linearise
    from mbs.analysis.periodic_motion import FloquetModel, floquet
    from mbs.common.affine import Affine, AffineVector
    from mbs.common.errors import ArgumentTypeError
    from mbs.compiler.compile import compile
    from mbs.model import Model, ModelError
    from mbs.results.accuracy import Accuracy, AccuracyWarning
    from mbs.results.animation import Animation, animate
    from mbs.results.poses import Poses
    from mbs.results.simulation_error import SimulationError
    from mbs.results.trajectory import Trajectory
    from mbs.roads import RoadFile, RoadFileError, RoadWarning, read_road, write_road
    from mbs.settings.control import Control
    from mbs.settings.settings import Settings
    from mbs.simulation.branch_warning import BranchWarning
    from mbs.simulation.large_bending import BendingWarning
    from mbs.simulation.many_runs import ManyRuns, Variant, simulate_many
    from mbs.simulation.parameter_warning import ParameterWarning
    from mbs.simulation.run import simulate
    from mbs.simulation.state import Pose
    from mbs.simulation.stepping import Simulation
    from mbs.system.compiled_model import SystemFileError
    from mbs.system.system import System

# imported when they are first asked for: commands that need no engine start fast
_LAZY = {
    "Affine": "mbs.common.affine",
    "AffineVector": "mbs.common.affine",
    "ArgumentTypeError": "mbs.common.errors",
    "BranchWarning": "mbs.simulation.branch_warning",
    "Model": "mbs.model",
    "ModelError": "mbs.model",
    "System": "mbs.system.system",
    "SystemFileError": "mbs.system.compiled_model",
    "compile": "mbs.compiler.compile",
    "Accuracy": "mbs.results.accuracy",
    "AccuracyWarning": "mbs.results.accuracy",
    "Animation": "mbs.results.animation",
    "animate": "mbs.results.animation",
    "Control": "mbs.settings.control",
    "Poses": "mbs.results.poses",
    "Pose": "mbs.simulation.state",
    "RoadFile": "mbs.roads",
    "RoadFileError": "mbs.roads",
    "RoadWarning": "mbs.roads",
    "read_road": "mbs.roads",
    "write_road": "mbs.roads",
    "Settings": "mbs.settings.settings",
    "Simulation": "mbs.simulation.stepping",
    "SimulationError": "mbs.results.simulation_error",
    "Trajectory": "mbs.results.trajectory",
    "FloquetModel": "mbs.analysis.periodic_motion",
    "BendingWarning": "mbs.simulation.large_bending",
    "ParameterWarning": "mbs.simulation.parameter_warning",
    "LinearModel": "mbs.analysis.linear_model",
    "LinearisationWarning": "mbs.analysis.kinks",
    "floquet": "mbs.analysis.periodic_motion",
    "linearise": "mbs.analysis.linear_model",
    "ManyRuns": "mbs.simulation.many_runs",
    "Variant": "mbs.simulation.many_runs",
    "simulate": "mbs.simulation.run",
    "simulate_many": "mbs.simulation.many_runs",
}
# packages of their own too: mbs.vehicle.load("prototype")
__getattr__ = lazy_modules("mbs", ("elements", "flexible", "roads", "scenes", "shapes", "vehicle"), _LAZY)

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
    "ManyRuns",
    "Model",
    "ModelError",
    "ParameterWarning",
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
    "Variant",
    "animate",
    "compile",
    "floquet",
    "linearise",
    "read_road",
    "simulate",
    "simulate_many",
    "write_road",
]
