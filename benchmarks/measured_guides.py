"""The kerb test driven by accelerations: ``python -m benchmarks.measured_guides [--page] [--chart FILE] [--seeds N]``.

Four accelerometers of the chassis, as in the paper's experiment, become its way by double integration, with the drift
taken out where the car stands. Columns: errors of the motion that was found, rms; Newton iterations a step beside the
paper's (2 on average, 3 at most), most of a step, and tangents a step; how much later the moments at the four gauges
come than in the test with its smooth guide, how far they are off then (after the low-pass of 10 Hz, rms over their
rms), and the largest difference of a peak. Means over the seeds.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from ali3.files import write_text
from ali3.running import run_command
from benchmarks.paper import measured_guides
from benchmarks.paper.measured_guides_chart import draw
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.pages import DOCS, replace, table
from benchmarks.shared.tables import print_table
from mbs import compile, simulate
from mbs.scenes import kerb_test

PAGE = DOCS / "flexible_car.md"
SEEDS = 3


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, print, and write what was asked for."""
    parser = parser_of("measured_guides", __doc__, chart="speed and moments of one seed")
    parser.add_argument("--page", action="store_true", help="write the table of docs/flexible_car.md")
    parser.add_argument("--seeds", type=int, default=SEEDS, metavar="N", help="noises per row; default: %(default)s")
    options = parser.parse_args(arguments)
    true = measured_guides.smooth()
    plain = simulate(compile(kerb_test.build()), kerb_test.DURATION, kerb_test.STEP)
    none = dict.fromkeys(measured_guides.COLUMNS)
    rows = [none | measured_guides.PAPER, none | {"guide": "smooth", **measured_guides.cost(plain)}]
    rows += [
        measured_guides.row(name, true, plain, range(options.seeds)) for name in watched(list(measured_guides.CASES))
    ]
    print_table(rows, measured_guides.COLUMNS)
    save_rows(options.json, "measured_guides", rows, seeds=options.seeds)
    if options.page:
        text = replace(PAGE.read_text(encoding="utf-8"), {"measured guides": table(rows, measured_guides.COLUMNS)})
        write_text(PAGE, text)
    if options.chart:
        draw(true, plain, options.chart)
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
