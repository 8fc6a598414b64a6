"""What tyres lose from one formula to the other: largest differences of curves of pure slip."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from benchmarks.shared.pages import Row, table
from mbs.elements.magic_tyre import MagicTyre
from mbs.elements.tyre import Tyre
from mbs.tyre_files import read_tyre
from mbs.tyre_files.fits import magic_of_tmeasy, tmeasy_of_magic
from mbs.vehicle import load

CHRONO = Path(__file__).parents[2] / "tests" / "tyre_files" / "data" / "chrono"
TRUCK = CHRONO / "HMMWV_Pac02Tire.tir"
COLUMNS = {"tyre": "", "as": "", "longitudinal, %": ".1f", "lateral, %": ".1f", "moment, %": ".0f"}


def measure(name: str, tyre: Tyre | MagicTyre) -> Row:
    """A row of the table: a tyre as the other formula has it."""
    if isinstance(tyre, Tyre):
        other, (_, errors) = "Magic Formula", magic_of_tmeasy(tyre)
    else:
        other, (_, errors) = "TMeasy", tmeasy_of_magic(replace(tyre, pressure=0.0))
    return {"tyre": name, "as": other, **{f"{key}, %": 100.0 * error for key, error in errors.items()}}


def tyre_rows(files: Sequence[Path]) -> list[Row]:
    """Those of the cars, then those of the files."""
    cars = [measure(f"{name}, front", load(name).front.tyre.tyre("left")) for name in ("hatchback", "saloon")]
    return cars + [measure(file.name, read_tyre(file).tyre()) for file in files]


def fit_table() -> str:
    """The table of decision 96."""
    return table(tyre_rows([TRUCK]), COLUMNS)
