"""The N-four-bar: ``python -m benchmarks.double_four_bar [--json FILE] [--chart FILE] [--quick]``.

Ten seconds through ten singular positions, against the exact reduction to one angle; the paper's Table 1 beside it.
With ``--settings`` only the energy deviations of other settings beside that table.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from ali3.running import run_command
from benchmarks.paper.double_four_bar import (
    END,
    METHODS,
    PAPER,
    PAPER_ROWS,
    REPEATS,
    compare_with_paper,
    cost_of_accuracy,
    draw,
    measure_all,
    settings_tried,
)
from benchmarks.shared.command import parser_of, save_rows
from benchmarks.shared.tables import print_table
from benchmarks.shared.warned import wrong_on_purpose

WINDOWS = (1, 2, 40, 200, 1000)
TABLE = {
    "method": "",
    "N": "d",
    "h_s": "g",
    "energy_deviation_J": ".3g",
    "position_error_m": ".2e",
    "iterations_mean": ".2f",
    "iterations_max": "d",
    "us_per_step": ".2f",
    "us_reported": ".2f",
    "wall_s": ".2e",
    "realtime_factor": ".0f",
    "failed_at_s": ".3f",
}


@wrong_on_purpose()
def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("double_four_bar", __doc__, chart="error against wall time")
    parser.add_argument("--quick", action="store_true", help="N = 1 and 2 only")
    parser.add_argument("--settings", action="store_true", help="other settings at the paper's steps, nearest first")
    options = parser.parse_args(arguments)
    if options.settings:
        tried = settings_tried()
        print(f"{len(tried)} settings; the paper: {', '.join(f'{h:g} s {e:g} J' for h, (e, _) in PAPER.items())}")
        print_table(tried[:10])
        save_rows(options.json, "settings of the double four-bar", tried)
        return 0
    rows = measure_all(WINDOWS[:2] if options.quick else WINDOWS, REPEATS)
    print()
    print_table(rows, TABLE)
    print("\nThe paper's Table 1 (Matlab, its own machine) beside this run, N = 2; ratio = paper / here")
    print_table(compare_with_paper(rows), dict.fromkeys(compare_with_paper(rows)[0], ".3g"))
    print("\nRatios within this run, N = 2")
    ratios = cost_of_accuracy(rows)
    print_table(ratios, dict.fromkeys(ratios[0], ".3g"))
    save_rows(
        options.json,
        "double four-bar",
        rows,
        end_s=END,
        repeats=REPEATS,
        warm_up=1,
        wall="least of repeats through all rows, time in the kernel's step loop",
        methods={name: settings.kernel_fields() for name, settings in METHODS.items()},
        paper_table_1=PAPER_ROWS,
    )
    if options.chart is not None:
        draw(rows, options.chart)
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
