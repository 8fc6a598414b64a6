"""The rigid bicycle against what is published and against rolling outside the kernel:
``python -m benchmarks.bicycle [--json FILE] [--quick]``.

Published: J. P. Meijaard, J. M. Papadopoulos, A. Ruina, A. L. Schwab, "Linearized dynamics equations for the balance
and steer of a bicycle: a benchmark and review", Proceedings of the Royal Society A 463, 2007, 1955-1982.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from ali3.running import run_command
from benchmarks.methods.bicycle import linear, measure
from benchmarks.methods.kernel_methods import suits
from benchmarks.references.cases import system_of
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.tables import print_table
from mbs.scenes import bicycle
from mbs.settings.settings import METHODS

STEPS = (0.02, 0.01, 0.005)
TABLE = {
    "method": "",
    "h_s": "g",
    "error": ".2e",
    "energy_deviation_J": ".2e",
    "iterations_a_step": ".2f",
    "factorizations": "d",
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("bicycle", __doc__)
    parser.add_argument("--quick", action="store_true", help="one step size")
    options = parser.parse_args(arguments)
    straight = linear()
    print_table(straight, {"at 5 m/s": "", "published": ".8f", "system": ".10f", "outside": ".8f"})
    print(f"\nFrom upright at {bicycle.SPEED:g} m/s with a lean rate of {bicycle.LEAN_RATE:g} rad/s:")
    methods = [method for method in METHODS if suits(method, True, system_of("bicycle"))]
    steps = STEPS[1:2] if options.quick else STEPS
    rows = [measure(method, h) for method, h in watched([(m, h) for m in methods for h in steps])]
    print_table(rows, TABLE)
    save_rows(options.json, "bicycle", rows, linear=straight)
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
