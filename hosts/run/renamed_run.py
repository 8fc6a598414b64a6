"""A run of an FMU whose variables have other names: its manoeuvre and its result have ours."""

from dataclasses import replace
from pathlib import Path

from hosts.common.options import FmuOptions
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.manoeuvre_settings import apply_settings
from hosts.driving.simulated_fmu import SimulatedFmu
from hosts.fmu.fmu import Fmu
from hosts.fmu.fmu_source import FmuSource
from hosts.fmu.settings import Settings


class RenamedRun:
    """The FMU through an alias file.

    `file`: of ``--aliases``. `fmu`: under our names; `names`: for the record of a run.
    """

    def __init__(self, fmu: Fmu, file: Path) -> None:
        self._own = fmu
        self._source = FmuSource.named(fmu.path, fmu.table, file)
        self.fmu: SimulatedFmu = self._source.seen(fmu)
        self.names = self._source.of_record

    def apply_settings(
        self, manoeuvre: Manoeuvre, fmu_options: FmuOptions, fidelity: float | None = None
    ) -> tuple[Manoeuvre, Settings]:
        """See `hosts.driving.manoeuvre_settings.apply_settings`; settings have names and units of the FMU."""
        fmu_manoeuvre, settings = apply_settings(self._own, manoeuvre, fmu_options, fidelity, self._source.fmu_values)
        return replace(fmu_manoeuvre, start=self._source.ali3_values(fmu_manoeuvre.start)), settings
