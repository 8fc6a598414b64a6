"""Flexible scenes and the car: ``python -m benchmarks.dissipative [--json FILE] [--quick]``.

Scenes without an exact motion: what is right is a stored run of an independent program, a reference with a much
smaller step, or a balance. Every method of the kernel over a few steps: fine, wrong, or refused with a reason.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from ali3.running import run_command
from benchmarks.methods.dissipative import SCENES, measure
from benchmarks.methods.kernel_methods import CONSERVATIVE_ONLY, KERNEL, TREE_ONLY
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.tables import print_table
from benchmarks.shared.warned import wrong_on_purpose

TABLE = {
    "scene": "",
    "method": "",
    "h_s": "g",
    "outcome": "",
    "error": ".1e",
    "limit": "g",
    "iterations": ".2f",
    "violation_m": ".0e",
    "wall_s": ".2g",
    "reason": "",
}
METHODS = [method for method in KERNEL if method not in (*CONSERVATIVE_ONLY, *TREE_ONLY)]
QUICK = ("spinning_beam", "car_at_rest_100s")


@wrong_on_purpose()
def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("dissipative", __doc__)
    parser.add_argument("--scene", action="append", choices=list(SCENES), help="a scene; may be given again")
    parser.add_argument("--quick", action="store_true", help="two scenes, the default method, one step")
    options = parser.parse_args(arguments)
    rows = []
    for name in watched(options.scene or (QUICK if options.quick else list(SCENES))):
        for method in ("ali3p",) if options.quick else METHODS:
            rows += [measure(name, method, h) for h in ((0.01,) if options.quick else SCENES[name].steps)]
    print_table(rows, TABLE)
    save_rows(options.json, "dissipative", rows)
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
