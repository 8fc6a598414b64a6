"""What tyres lose from one formula to the other: ``python -m benchmarks.tyre_fits [FILE ...]``.

The largest differences of curves of pure slip, over the largest force or moment at each load, as the fits of
`mbs.tyre_files.fits` tell them: the hatchback as Magic Formula, the saloon and each FILE (.tir) as TMeasy.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from ali3.running import run_command
from benchmarks.shared.command import parser_of, save_rows
from benchmarks.shared.machine import describe
from benchmarks.shared.pages import Row, table
from benchmarks.shared.tables import print_table
from mbs.elements import MagicTyre, Tyre
from mbs.tyre_files import read_tyre
from mbs.tyre_files.fits import magic_of_tmeasy, tmeasy_of_magic
from mbs.vehicle import load

CHRONO = Path(__file__).parents[1] / "tests" / "tyre_files" / "data" / "chrono"
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


def main(arguments: Sequence[str] | None = None) -> int:
    """Fit, print, and write what was asked for."""
    parser = parser_of("tyre_fits", __doc__)
    parser.add_argument("files", nargs="*", type=Path, metavar="FILE", help="tyre property file; default: of a truck")
    options = parser.parse_args(arguments)
    rows = tyre_rows(options.files or [TRUCK])
    print_table(rows, COLUMNS)
    save_rows(options.json, describe("tyre_fits"), rows)
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
