"""Reads car files."""

import warnings
from functools import cache
from pathlib import Path

from ali3.near_names import did_you_mean
from ali3.reading import read_toml
from mbs.common.checks import shown
from mbs.vehicle.built_car import checked_car
from mbs.vehicle.car import Car
from mbs.vehicle.errors import CarFileError, CarWarning
from mbs.vehicle.linkages.free_travel import notes_without_stops

FILE = "car.toml"
CARS = Path(__file__).parent / "cars"


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
        The car has unusual properties, such as an equilibrium that differs from the drawing.
    """
    if isinstance(car, str) and car in car_names():
        return _package_car(car)
    if not isinstance(car, (str, Path)):
        raise CarFileError(f"A car is the name of one, a folder or a file, not {shown(car)}.")
    path = find_car_file(car)
    if path.suffix.lower() == ".fmu":
        raise CarFileError(f"{path} is an FMU; a car is the name of one, a folder with a file {FILE}, or such a file.")
    loaded_car = checked_car(Car, read_toml(path, CarFileError), path.parent, str(path), warn=True)
    if loaded_car.front.suspension.stop_left_out or None in (loaded_car.front.stops, loaded_car.rear.stops):
        for sentence in notes_without_stops(loaded_car):
            warnings.warn(f"{path}: {sentence}", CarWarning, stacklevel=2)
    return loaded_car


def find_car_file(car: str | Path) -> Path:
    """Path of the file of a car from its folder or file. Raises `CarFileError` if there is none."""
    path = Path(car)
    try:
        if path.is_dir():
            path = path / FILE
        exists = path.exists()
    except (OSError, ValueError):
        exists = False
    if not str(car) or not exists:
        names = car_names()
        file = "" if "\0" in str(car) else f": no file {path}"
        suggestion = did_you_mean(str(car), names, f"the cars of the package are {', '.join(names)}", 1)
        raise CarFileError(f"There is no car {shown(str(car))}{file}{suggestion}")
    return path


@cache
def _package_car(name: str) -> Car:
    """Read a car of the package, cached."""
    path = CARS / name / FILE
    # the equilibrium is checked by a test
    return checked_car(Car, read_toml(path, CarFileError), path.parent, str(path), at_rest=False)
