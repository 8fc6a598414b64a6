"""System restored at a saved state of another instance."""

from collections.abc import Mapping

from mbs.kernel.binding import KernelError
from mbs.results.simulation_error import SimulationError
from mbs.settings.settings import Settings
from mbs.simulation.stepped_system import SteppedSystem
from mbs.system.system import System


def restore_system(system: System, settings: Settings, road_paths: Mapping[int, str], state: bytes) -> SteppedSystem:
    """Make a second instance of a System at a saved state.

    `road_paths`: road files by the number of the road; `state`: bytes from `Instance.save`. Raises `SimulationError` if
    a road file cannot be read any more.
    """
    simulation = SteppedSystem(system, settings)
    try:
        for road, path in road_paths.items():
            simulation.instance.set_road(road, path)
    except KernelError as error:
        raise SimulationError(str(error), 0.0, error.status) from error
    simulation.road_paths = dict(road_paths)
    simulation.instance.restore(state)
    return simulation
