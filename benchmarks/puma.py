"""The PUMA 560 whose hand is pinned and released: ``python -m benchmarks.puma [--json FILE] [--quick] [--split]``.

The paper's Table 2 beside ours: distance between the first and the last position of the hand, after eight seconds.
With `--split` also where that error comes from: large steps in one stage only.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import mbs
from ali3.running import run_command
from benchmarks.paper.puma import LARGE, SMALL, measure, split
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.tables import print_table
from mbs.scenes import puma

STEPS = (0.1, 0.05, 0.02, 0.01, 0.005)
METHODS = ("ali3p", "energy_momentum", "energy_momentum_4", "runge_kutta_8", "radau_5")
REPEATS = 5
TABLE = {
    "method": "",
    "h_s": "g",
    "error_mm": ".3g",
    "path_error_mm": ".3g",
    "jump_close_J": ".2e",
    "jump_open_J": ".2e",
    "cpu_s": ".2e",
    "paper_error_mm": ".3g",
    "paper_wall_s": ".3g",
    "ended": "",
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("puma", __doc__)
    parser.add_argument("--quick", action="store_true", help="one method, one repeat")
    parser.add_argument("--split", action="store_true", help=f"also the share of each stage at h = {LARGE} s")
    options = parser.parse_args(arguments)
    system = mbs.compile(puma.build())
    repeats = 1 if options.quick else REPEATS
    rows = [
        measure(system, method, h, repeats)
        for method, h in watched([(m, h) for m in (METHODS[:1] if options.quick else METHODS) for h in STEPS])
    ]
    print_table(rows, TABLE)
    if options.split:
        print(f"\n{METHODS[0]}, steps of {LARGE} s in one stage and {SMALL} s elsewhere")
        print_table(split(system, METHODS[0]), {"large steps in": "", "when pinned mm": ".3g", "error mm": ".3g"})
    save_rows(options.json, "puma", rows, repeats=repeats)
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
