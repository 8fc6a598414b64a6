"""Cars under test, and what their FMUs report."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

from hosts.common.errors import FailedFmuError
from hosts.common.numbers import Value
from hosts.driving.co_simulation import run
from hosts.driving.ground_marks import with_ground_marks
from hosts.driving.manoeuvre import Manoeuvre, with_names_of
from hosts.driving.pilots.pilot import Pilot
from hosts.driving.result import Result
from hosts.driving.run_checks import communication_step
from hosts.fmu.fmu_source import FmuSource
from hosts.fmu.variables import default_step

__all__ = ["CarFacts", "Pilot", "TestedCar"]


@dataclass(frozen=True)
class CarFacts:
    """What an FMU reports of its car."""

    inputs: tuple[str, ...]
    """Real and integer inputs, by ALi3 names, in the order of the FMU."""
    outputs: tuple[str, ...]
    """Real and integer outputs, likewise."""
    parameters: tuple[str, ...]
    """Real and integer parameters, likewise."""
    units: Mapping[str, str]
    """Units of all variables, by ALi3 names."""
    constants: Mapping[str, float]
    """Constants of the alias file, or of the FMU if there is none, by ALi3 names."""
    step: float
    """Communication step, s."""
    token: str = ""
    """Identifier of the build of the FMU."""


@dataclass(frozen=True)
class TestedCar:
    """A car under test: its FMU and settings."""

    __test__ = False  # pytest must not collect it

    label: str
    fmu: FmuSource
    start: Mapping[str, Value] = field(default_factory=dict)
    """Start values by ALi3 names."""
    step: float | None = None
    """Communication step, s; by default that of the FMU."""

    def drive(
        self,
        manoeuvre: Manoeuvre,
        pilot: Pilot | None = None,
        until: Callable[[float, Mapping[str, float]], bool] | None = None,
        record_step: float | None = None,
    ) -> Result:
        """Drive a new instance of the FMU.

        Parameters
        ----------
        manoeuvre : Manoeuvre
            Inputs over time, start values, stop time; by ALi3 names, in SI units.
        pilot : Pilot, optional
            Replaces the inputs that it sets.
        until : callable, optional
            Function of the time and the outputs; the run ends with the first step after which it is true.
        record_step : float, optional
            Interval of the record, s, rounded to whole steps; by default every step.

        Returns
        -------
        Result
            Signals by ALi3 names. `failed_steps` is 1 if the FMU refused a step; the record ends before it.

        Raises
        ------
        HostError
            If the FMU cannot be loaded or started, a name is unknown, a value is out of its range, or an output is not
            finite.
        """
        with self.fmu.opened() as fmu:
            manoeuvre = with_names_of(manoeuvre, fmu.variables)
            start = {**self.start, **manoeuvre.start}
            step = communication_step(fmu, manoeuvre, self.step)
            steps_per_row = 1 if record_step is None else max(1, round(record_step / step))
            driven = run(fmu, replace(manoeuvre, start=start), step, pilot, until=until, every=steps_per_row)
            result = with_ground_marks(driven, pilot)
            if fault := result.not_finite():
                raise FailedFmuError(f"{fault} That run is not evaluated.")
            return result

    @cached_property
    def facts(self) -> CarFacts:
        """What the FMU reports of its car."""
        with self.fmu.opened() as fmu:
            return CarFacts(
                inputs=tuple(fmu.names("input")),
                outputs=tuple(fmu.names("output")),
                parameters=tuple(fmu.names("parameter")),
                units={name: variable.unit or "1" for name, variable in fmu.variables.items()},
                constants=fmu.constants(),
                step=default_step(fmu.description) if self.step is None else self.step,
                token=str(fmu.description.guid or fmu.description.instantiationToken or ""),
            )

    @property
    def path(self) -> Path:
        """Path of the FMU."""
        return self.fmu.path
