"""Four-bar with assembly defect: ``python -m benchmarks.assembly_defect [--json FILE] [--chart FILE] [--quick]``.

Section forces in the middle of the coupler (paper, section 3.3, Figure 5) against an independent program with
geometrically exact beams, for bars of 1, 2, 4 and 8 flexible bodies and several sets of modes.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

from ali3.running import run_command
from benchmarks.paper.assembly_defect import STEP, draw, measure, peaks, refusal
from benchmarks.references.assembly_defect import ORIGIN, reference
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.tables import print_table
from benchmarks.shared.warned import wrong_on_purpose
from mbs.scenes import assembly_defect_four_bar as scene

# bodies per bar, elements per body, dynamic modes per body
CASES = ((1, 2, 0), (1, 4, 2), (1, 8, 6), (2, 2, 0), (2, 4, 2), (4, 2, 0), (4, 4, 2), (8, 2, 0))
FEW = CASES[:1]
TABLE = {
    "bodies_per_bar": "d",
    "elements": "d",
    "modes": "d",
    "coordinates": "d",
    "rows": "d",
    "T_error": ".2%",
    "My_error": ".2%",
    "Mz_error": ".2%",
    "largest_of_moment": ".2%",
    "iterations_mean": ".2f",
    "iterations_max": "d",
    "wall_s": ".3g",
    "realtime_factor": ".1f",
}


@wrong_on_purpose()
def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("assembly_defect", __doc__, chart="the moments over time")
    parser.add_argument("--quick", action="store_true", help="one flexible body per bar only")
    options = parser.parse_args(arguments)
    expected = reference()
    rows: list[dict[str, Any]] = []
    repeats = 1 if options.quick else 3
    for case in watched(FEW if options.quick else CASES):
        row, run = measure(case, expected, repeats)
        rows.append(row)
    about = {"end_s": scene.DURATION, "h_s": STEP, "reference": ORIGIN}
    print(f"Against {ORIGIN};")
    print("largest difference as a fraction of the peak of each moment, and of the largest of all moments\n")
    print_table(rows, TABLE)
    print("\nLargest moments by the diameter of the bars, N m")
    print_table([peaks(radius) for radius in (scene.RADIUS, 0.5 * scene.RADIUS)])
    print(f"\nWith rigid bars: {refusal()}")
    save_rows(options.json, "four-bar with assembly defect", rows, repeats=repeats, warm_up=1, **about)
    if options.chart is not None:
        draw(run, expected, rows[-1]["bodies_per_bar"], options.chart)
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
