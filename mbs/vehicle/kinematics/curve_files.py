"""Curves as CSV files with names and units in the headings, in SI units and with all digits."""

from __future__ import annotations

import csv
import re
from os import PathLike
from pathlib import Path

import numpy as np

from ali3.files import whole_file
from mbs.common.checks import shown
from mbs.vehicle.kinematics.curves import DIRECTIONS, Curve
from mbs.vehicle.kinematics.quantities import BY_NAME

_HEADING = re.compile(r"(?P<name>[a-z_]+) \[(?P<unit>[^\]]+)\]")


def write_curve(curve: Curve, file: str | PathLike[str]) -> None:
    """Write a curve, one column per quantity headed ``name [unit]``.

    Parameters
    ----------
    curve : Curve
        Of an axle.
    file : path
        To be written; one that exists is replaced when the new one is whole.

    Raises
    ------
    OSError
        It cannot be written.
    """
    with whole_file(file) as made, made.open("w", newline="", encoding="utf-8") as out:
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow([f"{name} [{unit}]" for name, unit in curve.units.items()])
        writer.writerows(np.column_stack(list(curve.columns.values())).tolist())


def read_curve(file: str | PathLike[str]) -> Curve:
    """Read what `write_curve` wrote to a file with the name of `curve_file`.

    Parameters
    ----------
    file : path
        As ``front_parallel.csv``.

    Raises
    ------
    OSError
        It cannot be read.
    ValueError
        Its name, a heading, a unit or a value is not what `write_curve` writes; the message names it.
    """
    axle, _, motion = Path(file).stem.partition("_")
    if axle not in ("front", "rear") or motion not in DIRECTIONS:
        raise ValueError(f"{file} must be called AXLE_MOTION.csv: front or rear, and one of {', '.join(DIRECTIONS)}.")
    with Path(file).open(newline="", encoding="utf-8") as lines:
        rows = list(csv.reader(lines))
    if not rows:
        raise ValueError(f"{file} is empty; it must begin with a line of headings.")
    names = [_checked(file, heading) for heading in rows[0]]
    columns: list[list[float]] = []
    for number, row in enumerate(rows[1:], start=2):
        if len(row) != len(names):
            raise ValueError(f"{file}, line {number}: {len(row)} values where {len(names)} belong.")
        try:
            columns.append([float(cell) for cell in row])
        except ValueError as error:
            raise ValueError(f"{file}, line {number}: {error}.") from None
    data = np.array(columns).reshape(-1, len(names))
    return Curve(axle, motion, dict(zip(names, data.T, strict=True)))


def curve_file(curve: Curve) -> str:
    """Name of the file of a curve, as ``front_parallel.csv``.

    Parameters
    ----------
    curve : Curve
        Of an axle.
    """
    return f"{curve.axle}_{curve.motion}.csv"


def _checked(file: str | PathLike[str], heading: str) -> str:
    match = _HEADING.fullmatch(heading)
    name = match["name"] if match else ""
    quantity = BY_NAME.get(name.removesuffix("_left").removesuffix("_right"))
    if match is None or quantity is None or quantity.unit != match["unit"]:
        what = (
            f"{name} [{quantity.unit}]" if quantity is not None else "the name and unit of a quantity, as name [unit]"
        )
        raise ValueError(f"{file}: the heading {shown(heading)} must be {what}.")
    return name
