"""Instance of a System in the kernel that is stepped, with its counters."""

from collections.abc import Mapping

from mbs.common.checks import instance_of
from mbs.kernel.binding import KernelError
from mbs.results.run_report import Report
from mbs.results.simulation_error import SimulationError
from mbs.settings.settings import Settings
from mbs.simulation.large_bending import BendingWatch
from mbs.simulation.prepared_system import prepared
from mbs.simulation.system_instance import SystemInstance
from mbs.system.system import System


class SteppedSystem(SystemInstance):
    """Instance of the kernel with the data that runs and error messages read.

    `step_tried`: last attempted step, s; `road_paths`: road files by the number of the road they replace.
    """

    system: System

    def __init__(self, system: System, settings: Settings) -> None:
        super().__init__(system, *prepared(system))
        self.change_settings(settings)
        self.bending = BendingWatch(system.frames)
        self.step_tried = 0.0
        self.road_paths: dict[int, str] = {}

    @property
    def report(self) -> Report:
        """Counters since the start and residuals of the last step."""
        return Report.from_kernel(self.instance.report())

    @property
    def branch_change(self) -> str:
        """A sentence about the first change of the assembly mode of a closed loop since the start; empty: none."""
        return self.instance.branch_text()

    @property
    def road_text(self) -> str:
        """A sentence about the wheel whose rim was pressed deepest into a road; empty if none was."""
        element, text = self.instance.rim_text()
        return f"{text} It is the wheel of '{prepared(self.system).meta['elements'][element]['name']}'." if text else ""

    @property
    def start_text(self) -> str:
        """A sentence about a start on a road that is not level; empty on a level road."""
        remedy = (
            " With Simulation.settle(3.0, h) before the first step it begins at rest in the road, or in its motion "
            "along it."
        )
        return text + remedy if (text := self.instance.start_text()) else ""

    def change_settings(self, settings: Settings) -> None:
        instance_of(Settings, settings, "The settings", "Settings(...)")
        self.instance.set_settings(**settings.kernel_fields())
        self.settings = settings


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
