"""What the model without savings costs: ``python -m benchmarks.naive [--json FILE]``.

Three scenes as they are, and as a naive model: every body with the twelve coordinates of its frame, every joint
equation a row, rods as bodies, wheels as bodies on hinges, planar mechanisms in space. Times are of the same engine.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from ali3.running import run_command
from benchmarks.methods.naive import DURATION, ROD_MASS, SCENES, H, measure
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.tables import print_table

COLUMNS = {
    "scene": "",
    "bodies": "d",
    "naive_bodies": "d",
    "coordinates": "d",
    "naive_coordinates": "d",
    "rows": "d",
    "naive_rows": "d",
    "us_per_step": ".1f",
    "naive_us_per_step": ".1f",
    "factor": ".1f",
    "difference": ".1e",
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, print, and write what was asked for."""
    parser = parser_of("naive", __doc__)
    parser.add_argument("--repeats", type=int, default=3, metavar="N", help="timed runs per row; default: 3")
    options = parser.parse_args(arguments)
    rows = [measure(scene, options.repeats) for scene in watched(list(SCENES))]
    print_table(rows, COLUMNS)
    save_rows(
        options.json,
        "naive",
        rows,
        repeats=options.repeats,
        warm_up=1,
        h_s=H,
        duration_s=DURATION,
        rod_mass_kg=ROD_MASS,
    )
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
