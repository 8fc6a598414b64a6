"""Reads cars by name, folder or file."""

from pathlib import Path

from mbs.vehicle.car import Car
from mbs.vehicle.read_car import read_car


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
    return read_car(car)
