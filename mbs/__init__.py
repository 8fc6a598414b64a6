"""ALi3: real-time multibody dynamics. Describe a `Model`, `compile` it to a `System`, step it."""

from typing import TYPE_CHECKING

from mbs.common.lazy_modules import lazy_modules

if TYPE_CHECKING:
    from mbs import elements as elements
    from mbs import flexible as flexible
    from mbs import roads as roads
    from mbs import scenes as scenes
    from mbs import shapes as shapes
    from mbs import vehicle as vehicle
    from mbs.analysis.kinks import LinearisationWarning as LinearisationWarning
    from mbs.analysis.linear_model import LinearModel as LinearModel
    from mbs.analysis.linear_model import linearise as linearise
    from mbs.analysis.periodic_motion import FloquetModel as FloquetModel
    from mbs.analysis.periodic_motion import floquet as floquet
    from mbs.common.affine import Affine as Affine
    from mbs.common.affine import AffineVector as AffineVector
    from mbs.common.errors import ArgumentTypeError as ArgumentTypeError
    from mbs.compiler.compile import compile as compile
    from mbs.model import Model as Model
    from mbs.model import ModelError as ModelError
    from mbs.results.accuracy import Accuracy as Accuracy
    from mbs.results.accuracy import AccuracyWarning as AccuracyWarning
    from mbs.results.animation import Animation as Animation
    from mbs.results.animation import animate as animate
    from mbs.results.equilibrium_warning import EquilibriumWarning as EquilibriumWarning
    from mbs.results.poses import Poses as Poses
    from mbs.results.simulation_error import SimulationError as SimulationError
    from mbs.results.step_control import Control as Control
    from mbs.results.trajectory import Trajectory as Trajectory
    from mbs.roads import RoadFile as RoadFile
    from mbs.roads import RoadFileError as RoadFileError
    from mbs.roads import RoadWarning as RoadWarning
    from mbs.roads import read_road as read_road
    from mbs.roads import write_road as write_road
    from mbs.settings.settings import Settings as Settings
    from mbs.simulation.branch_warning import BranchWarning as BranchWarning
    from mbs.simulation.large_bending import BendingWarning as BendingWarning
    from mbs.simulation.many_runs import ManyRuns as ManyRuns
    from mbs.simulation.many_runs import Variant as Variant
    from mbs.simulation.many_runs import simulate_many as simulate_many
    from mbs.simulation.parameter_warning import ParameterWarning as ParameterWarning
    from mbs.simulation.run import simulate as simulate
    from mbs.simulation.state import Pose as Pose
    from mbs.simulation.stepping import Simulation as Simulation
    from mbs.system.compiled_model import SystemFileError as SystemFileError
    from mbs.system.system import System as System

# imported at first use, so that commands without the engine start fast
_LAZY = {
    "Affine": "mbs.common.affine",
    "AffineVector": "mbs.common.affine",
    "ArgumentTypeError": "mbs.common.errors",
    "BranchWarning": "mbs.simulation.branch_warning",
    "EquilibriumWarning": "mbs.results.equilibrium_warning",
    "Model": "mbs.model",
    "ModelError": "mbs.model",
    "System": "mbs.system.system",
    "SystemFileError": "mbs.system.compiled_model",
    "compile": "mbs.compiler.compile",
    "Accuracy": "mbs.results.accuracy",
    "AccuracyWarning": "mbs.results.accuracy",
    "Animation": "mbs.results.animation",
    "animate": "mbs.results.animation",
    "Control": "mbs.results.step_control",
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
# packages are attributes too: mbs.vehicle.load("prototype")
__getattr__ = lazy_modules("mbs", ("elements", "flexible", "roads", "scenes", "shapes", "vehicle"), _LAZY)

__all__ = [*_LAZY]
