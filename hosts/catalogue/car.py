"""Cars under test: FMUs with parameter sets, side by side, and what they report."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

from hosts.common.errors import FailedFmuError, HostError
from hosts.common.numbers import Value
from hosts.common.options import FmuOptions
from hosts.driving.co_simulation import run
from hosts.driving.ground_marks import with_ground_marks
from hosts.driving.manoeuvre import Manoeuvre, with_names_of
from hosts.driving.pilots.pilot import Pilot
from hosts.driving.result import Result
from hosts.driving.run_checks import communication_step
from hosts.fmu.fmu import Fmu
from hosts.fmu.fmu_source import FmuSource
from hosts.fmu.settings import settings_of
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


AS_IS = "as-is"
"""In place of a parameter set: the FMU as it is."""
NO_ALIASES = "none"
"""Instead of an alias file: the FMU has ALi3 names."""
_SET_BY_TESTS = (
    *("initial.speed", "initial.lateral_speed", "initial.yaw_rate", "initial.settling"),
    *("initial.x", "initial.y", "initial.z", "initial.yaw"),
)


def cars_of(
    fmus: Sequence[Path],
    alias_files: Sequence[Path],
    sets: Sequence[Path],
    values: Sequence[tuple[str, str]],
    step: float | None = None,
) -> list[TestedCar]:
    """Every FMU with every parameter set, after checking that it can be loaded.

    Parameters
    ----------
    alias_files : sequence of Path
        None, one for all FMUs, or one for each; names of alias files of the package, such as ``chrono``, are allowed;
        `NO_ALIASES` is none.
    sets : sequence of Path
        SSV files; `AS_IS` is none. Without any, the FMUs as they are.
    values : sequence of (str, str)
        Values that are set in all cars, in the names and units of the FMU.
    step : float, optional
        Communication step of all cars, s.

    Raises
    ------
    HostError
        If an FMU cannot be used, or a name, value or unit is wrong.
    """
    if len(alias_files) not in (0, 1, len(fmus)):
        raise HostError(
            f"There are {len(fmus)} FMUs and {len(alias_files)} alias files; give one file for all FMUs, or one for "
            "each in their order."
        )
    if step is not None and not 0.0 < step <= 0.1:
        raise HostError(f"The step is {step:g} s; it must be positive and at most 0.1 s for these tests.")
    cars = []
    for k, fmu in enumerate(fmus):
        file = None if not alias_files else alias_files[0 if len(alias_files) == 1 else k]
        cars += _cars_of_fmu(fmu, file, sets or [Path(AS_IS)], values, step)
    return _with_unique_labels(cars)


def _cars_of_fmu(
    path: Path, alias_file: Path | None, sets: Sequence[Path], values: Sequence[tuple[str, str]], step: float | None
) -> list[TestedCar]:
    cars = []
    with Fmu(path) as fmu:
        file = None if alias_file is None or str(alias_file) == NO_ALIASES else alias_file
        source = FmuSource.named(path, fmu.table, file)
        for set_file in sets:
            fmu_options = FmuOptions([] if str(set_file) == AS_IS else [set_file], list(values))
            start = settings_of(fmu.table, fmu_options).start
            label = path.stem if str(set_file) == AS_IS else f"{path.stem}, {set_file.stem}"
            cars.append(TestedCar(label, source, _ali3_start_values(start, source), step))
    for car in cars:
        assert car.facts
    return cars


def _ali3_start_values(start: Mapping[str, Value], source: FmuSource) -> dict[str, Value]:
    """Start values under ALi3 names, in ALi3 units."""
    ali3_start = source.ali3_values(start)
    for name in ali3_start:
        if name in _SET_BY_TESTS:
            raise HostError(
                f"'{name}' of {source.path.name} cannot be given: the tests themselves say where a car starts and how "
                "fast; --test-setting sets what may be changed (--list shows it)."
            )
    return ali3_start


def _with_unique_labels(cars: Sequence[TestedCar]) -> list[TestedCar]:
    """The cars, with numbers added to equal labels."""
    counts: dict[str, int] = {}
    labelled = []
    for car in cars:
        counts[car.label] = counts.get(car.label, 0) + 1
        count = counts[car.label]
        labelled.append(car if count == 1 else replace(car, label=f"{car.label} ({count})"))
    return labelled
