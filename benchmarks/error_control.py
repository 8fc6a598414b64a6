"""Runs to a tolerance: ``python -m benchmarks.error_control [--scene NAME ...] [--json FILE] [--quick]``.

Every scene of the charts at several tolerances by every method that may be chosen, and by the choice itself: error
reached over the tolerance, processor time of all that `simulate` did, and that of the choice over that of the best
method that kept its error within ten tolerances. The last table holds the misses: a choice that took more than twice
the best, or an error beyond ten tolerances without a warning.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

from ali3.running import run_command
from benchmarks.methods.error_control import CHOSEN, REPEATS, TABLE, compare, measure, methods_of, misses
from benchmarks.references.cases import CASES
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.tables import print_table

TOLERANCES, QUICK_TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-6), (1e-3,)
QUICK = ("pendulum", "spatial_slider_crank")
SCENES = tuple(name for name in CASES if name not in ("pendulum_1000s", "four_bar_200"))


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("error_control", __doc__)
    parser.add_argument("--scene", action="append", choices=list(CASES), help="a scene; may be given again")
    parser.add_argument("--quick", action="store_true", help="two scenes, one tolerance")
    options = parser.parse_args(arguments)
    rows: list[dict[str, Any]] = []
    for scene in options.scene or (QUICK if options.quick else SCENES):
        for tolerance in QUICK_TOLERANCES if options.quick else TOLERANCES:
            names = [*methods_of(scene, tolerance), CHOSEN]
            part = [measure(scene, tolerance, m, 1 if options.quick else REPEATS) for m in watched(names)]
            compare(part)
            rows += part
            print_table(part, TABLE)
    wrong = misses(rows)
    chosen = sum(row["method"].startswith(CHOSEN) for row in rows)
    print(f"\n{chosen} choices, {len(wrong)} misses")
    print_table(wrong, TABLE)
    save_rows(options.json, "error_control", rows, repeats=1 if options.quick else REPEATS, misses=len(wrong))
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
