"""A second simulation that goes on from a state of a first one."""

from __future__ import annotations

from mbs.kernel.binding import KernelError
from mbs.results.simulation_error import SimulationError
from mbs.simulation.stepped_system import SteppedSystem


def twin(simulation: SteppedSystem, state: bytes) -> SteppedSystem:
    """Another one of the same System, with its settings and roads.

    Parameters
    ----------
    state : bytes
        That the simulation had, by `Instance.save`.

    Raises
    ------
    SimulationError
        The file of a road can no longer be read.
    """
    other = SteppedSystem(simulation.system, simulation.settings)
    try:
        for road, path in simulation.road_paths.items():
            other.instance.set_road(road, path)
    except KernelError as error:
        raise SimulationError(str(error), simulation.time, error.status) from error
    other.road_paths = dict(simulation.road_paths)
    other.instance.restore(state)
    return other
