"""A run of an FMU whose variables have other names: its manoeuvre and its result have ours."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from hosts.common.options import Wishes
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.manoeuvre_settings import set_in
from hosts.driving.simulated_fmu import SimulatedFmu
from hosts.fmu.aliased_fmu import seen_through
from hosts.fmu.aliases.of_file import aliases_of
from hosts.fmu.fmu import Fmu
from hosts.fmu.settings import Settings


class OtherNames:
    """The FMU through an alias file.

    `file`: of ``--aliases``. `fmu`: under our names; `names`: for the record of a run.
    """

    def __init__(self, fmu: Fmu, file: Path) -> None:
        self._own = fmu
        self._aliases = aliases_of(file, fmu.table)
        self.fmu: SimulatedFmu = seen_through(fmu, self._aliases)
        self.names = self._aliases.of_record

    def set_in(self, manoeuvre: Manoeuvre, wishes: Wishes, fidelity: float | None = None) -> tuple[Manoeuvre, Settings]:
        """See `hosts.driving.manoeuvre_settings.set_in`; wishes and settings are in the FMU's names and units."""
        theirs, settings = set_in(self._own, manoeuvre, wishes, fidelity, self._aliases.values)
        return replace(theirs, start=self._aliases.own_values(theirs.start)), settings
