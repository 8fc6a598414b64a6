"""Kinematic curves of an axle in CSV files, with names and SI units in the headings."""

import csv
from collections.abc import Mapping
from os import PathLike
from pathlib import Path

import numpy as np

from ali3.errors import TableError
from ali3.files import atomic_file
from ali3.message_text import brief
from ali3.tables import TextTable
from mbs.vehicle.kinematics.curves import DIRECTIONS, Curve
from mbs.vehicle.kinematics.quantities import BY_NAME


def write_curve(curve: Curve, file: str | PathLike[str]) -> None:
    """Write a curve, one column per quantity headed ``name [unit]``.

    Parameters
    ----------
    file : path
        File to write; an existing one is replaced only by a complete one.

    Raises
    ------
    OSError
        It cannot be written.
    """
    write_columns(file, curve.columns, curve.units)


def write_columns(file: str | PathLike[str], columns: Mapping[str, np.ndarray], units: Mapping[str, str]) -> None:
    """Write columns with their units in the headings, completely or not at all."""
    with atomic_file(file) as target, target.open("w", newline="", encoding="utf-8") as out:
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow([f"{name} [{unit}]" for name, unit in units.items()])
        writer.writerows(np.column_stack(list(columns.values())).tolist())


def read_curve(file: str | PathLike[str]) -> Curve:
    """Read a curve from a file that `write_curve` wrote under the name of `curve_file`.

    Parameters
    ----------
    file : path
        Named AXLE_MOTION.csv, for instance ``front_parallel.csv``.

    Raises
    ------
    TableError
        It cannot be read, or its name, a heading, a unit or a value is not what `write_curve` writes.
    """
    axle, _, motion = Path(file).stem.partition("_")
    if axle not in ("front", "rear") or motion not in DIRECTIONS:
        raise TableError(f"{file} must be called AXLE_MOTION.csv: front or rear, and one of {', '.join(DIRECTIONS)}.")
    table = TextTable(file, TableError, units=True)
    for name in table.names:
        _check_heading(file, name, table.units.get(name, ""))
    return Curve(axle, motion, dict(zip(table.names, table.values(finite=False, least=0).T, strict=True)))


def curve_file(curve: Curve) -> str:
    """File name of a curve, for instance ``front_parallel.csv``."""
    return f"{curve.axle}_{curve.motion}.csv"


def _check_heading(file: str | PathLike[str], name: str, unit: str) -> None:
    """Raise `TableError` if a heading is not name and unit of a quantity of curves."""
    quantity = BY_NAME.get(name.removesuffix("_left").removesuffix("_right"))
    if quantity is None or quantity.unit != unit:
        required = f"{name} [{quantity.unit}]" if quantity else "the name and unit of a quantity, as name [unit]"
        raise TableError(f"{file}: the heading {brief(f'{name} [{unit}]' if unit else name)} must be {required}.")
