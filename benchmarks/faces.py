"""Wheel loads at a kerb, at faces of grids and at edges that a road port answers: ``python -m benchmarks.faces``.

The car coasts in neutral up a step: the edge of a kerb, a face between two points of a grid, or with ``--answers`` what
a partner at the road port may answer.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from ali3.running import run_command
from benchmarks.car import edge_answers
from benchmarks.car.road_faces import COLUMNS, HEIGHTS, measure
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.tables import print_table


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, print, and write what was asked for."""
    parser = parser_of("faces", __doc__)
    parser.add_argument("--car", default="hatchback", help="default: hatchback")
    parser.add_argument("--answers", action="store_true", help="edges at the road port of two cars")
    options = parser.parse_args(arguments)
    if options.answers:
        rows = [edge_answers.measure(car, edge) for car, edge in watched(edge_answers.EDGES)]
    else:
        rows = [measure(options.car, height) for height in watched(HEIGHTS)]
    print_table(rows, edge_answers.COLUMNS if options.answers else COLUMNS)
    save_rows(options.json, "faces", rows)
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
