"""What tyres lose from one formula to the other: ``python -m benchmarks.tyre_fits [FILE ...]``.

The largest differences of curves of pure slip, over the largest force or moment at each load, as the fits of
`mbs.tyre_files.fits` tell them: the hatchback as Magic Formula, the saloon and each FILE (.tir) as TMeasy.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from ali3.running import run_command
from benchmarks.car.tyre_formulas import COLUMNS, TRUCK, tyre_rows
from benchmarks.shared.command import parser_of, save_rows
from benchmarks.shared.tables import print_table


def main(arguments: Sequence[str] | None = None) -> int:
    """Fit, print, and write what was asked for."""
    parser = parser_of("tyre_fits", __doc__)
    parser.add_argument("files", nargs="*", type=Path, metavar="FILE", help="tyre property file; default: of a truck")
    options = parser.parse_args(arguments)
    rows = tyre_rows(options.files or [TRUCK])
    print_table(rows, COLUMNS)
    save_rows(options.json, "tyre_fits", rows)
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
