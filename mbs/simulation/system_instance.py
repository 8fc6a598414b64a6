"""Instance of a System in the kernel and its state."""

from typing import Any

import numpy as np

from mbs.kernel.binding import LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.kernel.binding.kernel_memory import KernelMemory
from mbs.simulation.state import State
from mbs.simulation.unstepped_system import sensor_values
from mbs.system.compiled_model import CompiledModel


class SystemInstance(KernelMemory):
    """Instance of the kernel with access to its time, sensors and state.

    `loaded`: the System in the kernel's memory; `meta`: its metadata, which are not changed.
    """

    _reason = "its state is in the kernel; make another one of the System and let it restore() what save() gave"

    def __init__(self, system: CompiledModel, loaded: LoadedSystem, meta: dict[str, Any]) -> None:
        self.system, self._meta = system, meta
        self.instance = Instance(loaded)

    @property
    def time(self) -> float:
        """Time of the state, s."""
        return float(self.instance.time)

    @property
    def sensors(self) -> dict[str, float]:
        """Values of the sensors that the System computes, at the state, by name."""
        return sensor_values(self.instance, self._meta)

    @property
    def state(self) -> State:
        """A copy of the state."""
        return State(*(np.array(vector, float) for vector in self.instance.get_state()))
