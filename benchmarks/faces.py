"""Wheel loads at a kerb and at faces of grids: ``python -m benchmarks.faces [--car CAR]``.

The car coasts in neutral up a step, which is the edge of a kerb or a face between two points of a grid.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from ali3.running import run_command
from benchmarks.car.road_faces import COLUMNS, HEIGHTS, measure
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.machine import describe
from benchmarks.shared.tables import print_table


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, print, and write what was asked for."""
    parser = parser_of("faces", __doc__)
    parser.add_argument("--car", default="hatchback", help="default: hatchback")
    options = parser.parse_args(arguments)
    rows = [measure(options.car, height) for height in watched(HEIGHTS)]
    print_table(rows, COLUMNS)
    save_rows(options.json, describe("faces"), rows)
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
