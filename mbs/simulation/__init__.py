"""Stepping a System: by hand with `Simulation`, or a whole run with `simulate`."""

from mbs.results.simulation_error import SimulationError
from mbs.simulation.run import simulate
from mbs.simulation.state import Pose, State
from mbs.simulation.stepping import Simulation

__all__ = ["Pose", "Simulation", "SimulationError", "State", "simulate"]
