"""System at its start, without steps."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mbs.common.errors import ModelError
from mbs.kernel.binding import KernelError, LoadedSystem, open_row
from mbs.kernel.binding.standing_instance import StandingInstance
from mbs.system.compiled_model import CompiledModel


class StandingSystem:
    """System at its consistent start, without road files and without the assembly modes of loops, which take long.

    `parameters`: values by name that differ from the model. Raises `ModelError` if the start cannot be made consistent
    or a value is out of its range.
    """

    def __init__(self, compiled: CompiledModel, parameters: Mapping[str, float] | None = None) -> None:
        self._meta = compiled.meta
        self._instance = StandingInstance(LoadedSystem(compiled.kernel_bytes(modes=False)))
        names = [entry["name"] for entry in compiled.meta["parameters"]]
        for name, value in (parameters or {}).items():
            try:
                self._instance.set_parameter(names.index(name), value)
            except KernelError as error:
                raise ModelError(f"The parameter '{name}' cannot be {value:g}: {error.message}") from None
        start(self._instance, self._meta)

    @property
    def sensors(self) -> dict[str, float]:
        """Values of the sensors that the System computes, by name."""
        return sensor_values(self._instance, self._meta)

    @property
    def q(self) -> NDArray[np.float64]:
        """Coordinates, shape (nq,)."""
        return np.array(self._instance.get_state()[0], float)


def start(instance: StandingInstance, meta: dict[str, Any]) -> None:
    """Make the start consistent; raise `ModelError` if that fails. `meta`: metadata of the System."""
    try:
        instance.initialise()
    except KernelError as error:
        worst = open_row(instance.report(), [row["name"] for row in meta["rows"]])
        text = f"The start could not be made consistent: {error.message}"
        raise ModelError(f"{text} Worst constraint: {worst}." if worst else text) from None


def sensor_values(instance: StandingInstance, meta: dict[str, Any]) -> dict[str, float]:
    """Values of the sensors that a System computes, by name. `meta`: metadata of the System."""
    values = zip(meta["sensors"], instance.sensors(), strict=True)
    return {s["name"]: v for s, v in values if s.get("computed", True)}
