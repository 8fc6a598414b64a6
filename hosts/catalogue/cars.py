"""The cars of a command: FMUs and parameter sets, side by side."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from hosts.catalogue.car import TestedCar
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.common.options import FmuOptions
from hosts.fmu.fmu import Fmu
from hosts.fmu.fmu_source import FmuSource
from hosts.fmu.settings import settings_of

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
