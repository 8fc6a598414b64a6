"""Reads a car file: every fault is one sentence with the file, the key path, the value and what would be right."""

from __future__ import annotations

import tomllib
import warnings
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from mbs.checks import shown
from mbs.errors import ModelError, SimulationError
from mbs.vehicle.car import Car
from mbs.vehicle.checks.car_checks import car_faults, car_oddities
from mbs.vehicle.checks.equilibrium import settled
from mbs.vehicle.errors import CarFileError, CarWarning
from mbs.vehicle.fidelity import Fidelity
from mbs.vehicle.files import text_of
from mbs.vehicle.schema_version import check_version
from mbs.vehicle.sentences import Sentences, one_line

FILE = "car.toml"
CARS = Path(__file__).parent / "cars"
MOST_FAULTS = 8


def car_names() -> list[str]:
    """Names of the cars that come with the package."""
    return sorted(file.parent.name for file in CARS.glob(f"*/{FILE}"))


def load(car: str | Path) -> Car:
    """Read a car.

    Parameters
    ----------
    car : str or Path
        Name of a car of the package, a folder with a file car.toml, or such a file.

    Returns
    -------
    Car
        Checked; its `model` gives the model.

    Raises
    ------
    CarFileError
        There is no such car, or its file is not right; the message has a sentence for each fault.

    Warns
    -----
    CarWarning
        A car of the user's that can be but is odd, such as one that does not come to rest where it is drawn.
    """
    if isinstance(car, str) and car in car_names():
        return _of_package(car)
    if not isinstance(car, (str, Path)):
        raise CarFileError(f"A car is the name of one, a folder or a file, not {shown(car)}.")
    path = file_of(car)
    return car_from(_content(path), path.parent, str(path), warn=True)


def file_of(car: str | Path) -> Path:
    """The file of a car that is given by its folder or file.

    Parameters
    ----------
    car : str or Path
        Folder or file.

    Raises
    ------
    CarFileError
        There is none.
    """
    path = Path(car)
    try:
        if path.is_dir():
            path = path / FILE
        there = path.exists()
    except (OSError, ValueError):
        there = False
    if not str(car) or not there:
        known = ", ".join(car_names())
        file = "" if "\0" in str(car) else f"no file {path}, and "
        raise CarFileError(f"There is no car {shown(str(car))}: {file}the cars of the package are {known}.")
    return path


@cache
def _of_package(name: str) -> Car:
    path = CARS / name / FILE
    return car_from(_content(path), path.parent, str(path), at_rest=False)  # a test holds that they stand as drawn


def _content(path: Path) -> dict[str, Any]:
    text = text_of(path)
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise CarFileError(f"{path} is no car file: its lists or tables are nested too deep.") from None
    except ValueError as error:
        raise CarFileError(f"{path} is no TOML file: {str(error).rstrip('.')}.") from error


def car_from(data: Mapping[str, Any], folder: Path, what: str, *, at_rest: bool = True, warn: bool = False) -> Car:
    """The car that the content of a file describes.

    Parameters
    ----------
    data : mapping
        Tables of the file.
    folder : Path
        Where its tables lie.
    what : str
        How messages call it.
    at_rest : bool
        Whether the car must be seen to come to rest.
    warn : bool
        Whether to warn of what is odd.

    Raises
    ------
    CarFileError
        It does not describe a car.
    """
    check_version(data, what)
    try:
        car = Car.model_validate(data)
    except ValidationError as error:
        raise CarFileError(_told(what, Sentences(Car, data).of(error))) from None
    car.locate("")
    car._folder = folder
    car._data = dict(data)
    faults = car_faults(car)
    if faults:
        raise CarFileError(_told(what, faults))
    if not at_rest:
        return car
    if car.has_frame:
        try:
            frame = car.flexible_frame
            if Fidelity.LOAD_PATHS in car.fidelities():
                frame.recorded_loads()
        except ModelError as error:
            raise CarFileError(_told(what, [str(error)])) from error
    try:
        rest = settled(car)
    except (ValueError, SimulationError) as error:
        raise CarFileError(_told(what, [f"as drawn it makes no car. {error}"])) from error
    faults = list(rest.faults(car))
    if faults:
        raise CarFileError(_told(what, faults))
    if warn:
        misfit = [f"fidelity 0 only, the frame does not fit the car. {car.misfit}"] if car.misfit else []
        for sentence in (*misfit, *car_oddities(car, rest)):
            warnings.warn(f"{what}: {one_line(sentence)}", CarWarning, stacklevel=3)
    return car


def _told(what: str, faults: Sequence[str]) -> str:
    told = [f"{what}: {one_line(fault)}" for fault in faults[:MOST_FAULTS]]
    if len(faults) > MOST_FAULTS:
        told.append(f"{what}: {len(faults) - MOST_FAULTS} more faults.")
    return "\n".join(told)
