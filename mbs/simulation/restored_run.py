"""System stepped on from a saved state of another instance."""

from collections.abc import Mapping

from mbs.kernel.binding import KernelError
from mbs.results.simulation_error import SimulationError
from mbs.settings.settings import Settings
from mbs.simulation.stepped_system import SteppedSystem
from mbs.system.system import System


def restored(system: System, settings: Settings, road_paths: Mapping[int, str], state: bytes) -> SteppedSystem:
    """A System at a state of another instance of it. `state`: by `Instance.save`.

    Raises `SimulationError`: the file of a road can no longer be read.
    """
    other = SteppedSystem(system, settings)
    try:
        for road, path in road_paths.items():
            other.instance.set_road(road, path)
    except KernelError as error:
        raise SimulationError(str(error), 0.0, error.status) from error
    other.road_paths = dict(road_paths)
    other.instance.restore(state)
    return other
