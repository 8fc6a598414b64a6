"""A System at its start, for those who make no steps from there."""

from __future__ import annotations

from mbs.common.errors import ModelError
from mbs.kernel.binding import KernelError, LoadedSystem, open_row
from mbs.simulation.system_instance import SystemInstance
from mbs.system.system import System


class StandingSystem(SystemInstance):
    """A System at its start, on roads that are no files; the assembly modes of its loops, which take long to find, are
    not watched.

    Raises `ModelError`: the start cannot be made consistent.
    """

    def __init__(self, system: System) -> None:
        loaded = LoadedSystem(system.to_bytes(drawing=False, modes=False))
        super().__init__(system, loaded, system.meta)
        try:
            self.instance.initialise()
        except KernelError as error:
            worst = open_row(self.instance.report(), [row["name"] for row in self._meta["rows"]])
            text = f"The start could not be made consistent: {error.message}"
            raise ModelError(f"{text} Worst constraint: {worst}." if worst else text) from None
