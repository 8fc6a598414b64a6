"""How cost grows: ``python -m benchmarks.growth [--json FILE] [--chart FILE] [--quick]``.

Time per step, memory and non-zeros of the factor of the N-four-bar for N = 1 to 1000 and of the car's frame with 5 to
200 dynamic modes, with fitted exponents; and the arithmetic of a step against what this machine could do in its time.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import mbs
from ali3.running import run_command
from benchmarks.methods.growth import (
    CHASSIS_EXPONENTS,
    CHASSIS_REPEATS,
    CHASSIS_STEP,
    END,
    EXPONENTS,
    FITTED_FROM,
    STEP,
    chassis,
    chassis_exponents,
    draw,
    exponents,
    measure,
)
from benchmarks.shared.command import parser_of, save_rows
from benchmarks.shared.machine import describe
from benchmarks.shared.tables import print_table

WINDOWS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
REPEATS = 9
MODES = (5, 10, 20, 50, 100, 200)  # dynamic ones of the chassis, beside 60 static and 6 inertia modes
TABLE = {
    "N": "d",
    "method": "",
    "coordinates": "d",
    "rows": "d",
    "factor_nonzeros": "d",
    "system_bytes": "d",
    "state_bytes": "d",
    "resident_bytes": "d",
    "iterations": ".2f",
    "us_per_step": ".2f",
    "us_per_iteration": ".3f",
    "operations_per_step": ".0f",
    "gflops": ".3f",
    "of_compiled_loop": ".1%",
    "of_dgemm": ".1%",
}
CHASSIS_TABLE = {
    "dynamic_modes": "d",
    "modes": "d",
    "coordinates": "d",
    "factor_nonzeros": "d",
    "system_bytes": "d",
    "state_bytes": "d",
    "iterations": ".2f",
    "us_per_step": ".1f",
    "us_per_iteration": ".1f",
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("growth", __doc__, chart="the growth")
    parser.add_argument("--quick", action="store_true", help="N up to 20, one repeat")
    options = parser.parse_args(arguments)
    repeats = 1 if options.quick else REPEATS
    rows = measure(WINDOWS[:5] if options.quick else WINDOWS, repeats)
    print_table(rows, TABLE)
    fitted = exponents(rows)
    print(f"\nExponents b of cost = a N^b from N = {FITTED_FROM}")
    print_table(fitted, {"method": ""} | dict.fromkeys(EXPONENTS, ".3f"))
    flexible = chassis(MODES[:2] if options.quick else MODES, 1 if options.quick else CHASSIS_REPEATS)
    flexible_fitted = chassis_exponents(flexible)
    print("\nThe car's frame alone, thrown and spinning, ALi3-P")
    print_table(flexible, CHASSIS_TABLE)
    print("Exponents b of cost = a n^b in all its modes n")
    print_table([flexible_fitted], dict.fromkeys(CHASSIS_EXPONENTS, ".3f"))
    first = rows[0]
    print(
        f"\nThis machine in one thread: {first['dgemm_gflops']:.1f} Gflop/s in NumPy's matrix product"
        + (
            f", {first['compiled_loop_gflops']:.1f} in a loop with the kernel's flags"
            if first["of_compiled_loop"]
            else ""
        )
    )
    about = {"step_s": CHASSIS_STEP, "rows": flexible, "exponents": flexible_fitted}
    meta = describe(
        "growth", mbs.Settings(), repeats=repeats, warm_up=1, step_s=STEP, end_s=END, exponents=fitted, chassis=about
    )
    save_rows(options.json, meta, rows)
    if options.chart is not None:
        draw(rows, options.chart)
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
