"""A System in the kernel: its instance, its state and its counters."""

from __future__ import annotations

import numpy as np

from mbs.common.checks import instance_of
from mbs.kernel.binding import Instance, LoadedSystem
from mbs.results.run_report import Report
from mbs.settings.settings import Settings
from mbs.simulation.large_bending import BendingWatch
from mbs.simulation.prepared_system import prepared
from mbs.simulation.state import State
from mbs.system.system import System


class SteppedSystem:
    """An instance of the kernel, and what runs and error messages read of it.

    Parameters
    ----------
    loaded : LoadedSystem, optional
        The System in the kernel's memory; by default the one that its Simulations share.

    Attributes
    ----------
    step_tried : float
        Length of the last step that was tried, s.
    road_paths : dict of int to str
        Files in place of roads, by the number of the road.
    """

    def __init__(self, system: System, settings: Settings, loaded: LoadedSystem | None = None) -> None:
        self.system, self.settings = system, settings
        shared, self._meta = prepared(system) if loaded is None else (loaded, system.meta)
        self.instance = Instance(shared)
        self.instance.set_settings(**settings.kernel_fields())
        self.bending = BendingWatch(system.frames)
        self.step_tried = 0.0
        self.road_paths: dict[int, str] = {}

    @property
    def time(self) -> float:
        """Time of the state, s."""
        return float(self.instance.time)

    @property
    def sensors(self) -> dict[str, float]:
        """Values of the sensors that the System computes, at the state, by name."""
        values = zip(self._meta["sensors"], self.instance.sensors(), strict=True)
        return {s["name"]: v for s, v in values if s.get("computed", True)}

    @property
    def report(self) -> Report:
        """Counters since the start and residuals of the last step."""
        return Report.from_kernel(self.instance.report())

    @property
    def branch_change(self) -> str:
        """A sentence about the first change of the assembly mode of a closed loop since the start; empty: none."""
        return self.instance.branch_text()

    @property
    def state(self) -> State:
        """A copy of the state."""
        return State(*(np.array(part, float) for part in self.instance.get_state()))

    def change_settings(self, settings: Settings) -> None:
        """Solve the steps from now on in another way."""
        instance_of(Settings, settings, "The settings", "Settings(...)")
        self.instance.set_settings(**settings.kernel_fields())
        self.settings = settings
