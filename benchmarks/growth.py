"""How cost grows: ``python -m benchmarks.growth [--json FILE] [--chart FILE] [--quick]``.

Time per step, memory and non-zeros of the factor of the N-four-bar for N = 1 to 1000 and of the car's frame with 5 to
200 dynamic modes, with fitted exponents; and the arithmetic of a step against what this machine could do in its time.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from ali3.running import run_command
from benchmarks.methods.growth import (
    CHASSIS_REPEATS,
    CHASSIS_STEP,
    END,
    STEP,
    chassis,
    chassis_exponents,
    draw,
    exponents,
    measure,
)
from benchmarks.methods.pages import growth_blocks
from benchmarks.shared.command import parser_of, save_rows
from benchmarks.shared.pages import print_blocks

WINDOWS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
REPEATS = 9
MODES = (5, 10, 20, 50, 100, 200)  # dynamic ones of the chassis, beside 60 static and 6 inertia modes


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("growth", __doc__, chart="the growth")
    parser.add_argument("--quick", action="store_true", help="N up to 20, one repeat")
    options = parser.parse_args(arguments)
    repeats = 1 if options.quick else REPEATS
    rows = measure(WINDOWS[:5] if options.quick else WINDOWS, repeats)
    flexible = chassis(MODES[:2] if options.quick else MODES, 1 if options.quick else CHASSIS_REPEATS)
    about = {"step_s": CHASSIS_STEP, "rows": flexible, "exponents": chassis_exponents(flexible)}
    fits = {"exponents": exponents(rows), "chassis": about}
    print_blocks(growth_blocks({"meta": fits, "rows": rows}))
    save_rows(options.json, "growth", rows, repeats=repeats, warm_up=1, step_s=STEP, end_s=END, **fits)
    if options.chart is not None:
        draw(rows, options.chart)
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
