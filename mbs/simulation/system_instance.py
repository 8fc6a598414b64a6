"""A System in the kernel: its instance and its state."""

from __future__ import annotations

from typing import Any

import numpy as np

from mbs.kernel.binding import Instance, LoadedSystem
from mbs.simulation.state import State
from mbs.system.system import System


class SystemInstance:
    """An instance of the kernel, and what is read of it wherever it stands.

    `loaded`: the System in the kernel's memory; `meta`: its names, which are not changed.
    """

    def __init__(self, system: System, loaded: LoadedSystem, meta: dict[str, Any]) -> None:
        self.system, self._meta = system, meta
        self.instance = Instance(loaded)

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
    def state(self) -> State:
        """A copy of the state."""
        return State(*(np.array(part, float) for part in self.instance.get_state()))
