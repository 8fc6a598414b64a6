"""The paper's test on the kerb: ``python -m benchmarks.kerb [--json FILE] [--steps H ...] [--fidelity F ...]``.

Size of the model, Newton iterations and time beside those of the paper (293 variables, 239 constraints, 65 modes; 2
iterations on average and 3 at most; 48 s for the 15 s). Peaks are the largest changes of the bending moments from rest
before and after a low-pass of 10 Hz, front (SG1) and rear (SG3), with their errors against those of all steps of the
reference. The last two columns: what is left of the moments at the end, as a part of the peak, while the tyres hold the
car sideways, and after their friction is set to zero.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from ali3.running import run_command
from benchmarks.car.fidelity import COMPARED, fidelity_of
from benchmarks.paper.kerb import COLUMNS, measure
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.tables import print_table
from mbs.scenes import kerb_test


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, print, and write what was asked for."""
    parser = parser_of("kerb", __doc__)
    parser.add_argument(
        "--steps", type=float, nargs="+", default=[kerb_test.STEP], metavar="H", help="s; default: 0.01"
    )
    parser.add_argument(
        "--fidelity", nargs="+", default=COMPARED, type=fidelity_of, metavar="F", help="numbers or names; default: all"
    )
    parser.add_argument("--repeats", type=int, default=3, metavar="N", help="timed runs per row; default: 3")
    options = parser.parse_args(arguments)
    todo = [(fidelity, h) for fidelity in options.fidelity for h in options.steps]
    rows = [measure(fidelity, h, options.repeats) for fidelity, h in watched(todo)]
    print_table(rows, COLUMNS)
    save_rows(options.json, "kerb", rows, repeats=options.repeats, warm_up=1)
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
