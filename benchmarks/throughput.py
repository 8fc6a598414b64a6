"""Cars a core: ``python -m benchmarks.throughput [--json FILE]``.

Slightly different cars drive the slalom at 5 ms and the lane change at 10 ms, with links and by tables (fidelity 10),
and the slalom with a flexible frame; cars with one, each a step further than the one before, meet the kerb at 10 ms.
Four-bar mechanisms of 2 and 40 windows swing at 10 ms from slightly different speeds; flexible four-bars with a defect
turn, each a step further. All advance one after the other, in lanes of each width that the processor has, and in the
widest lanes on all cores. Each way makes a part of the same steps in
turn, so that ratios hold on a busy machine; seconds are those in which its threads had a core, and of several rounds
each part counts by its least. With ``--older FOLDER``, a clone at another commit whose kernel is compiled, only
the cars with links run, and those of the clone make the same steps one after the other in turn.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from ali3.running import run_command
from benchmarks.car.lanes import CARS, SECONDS, Start, measure, one_after_another, varied_cars, varied_four_bars
from benchmarks.car.older_cars import older_cars
from benchmarks.car.speed_pages import THOUSAND, thousand
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.tables import print_table
from mbs import System
from mbs.kernel.binding import KernelError
from mbs.scenes import assembly_defect_four_bar, kerb_test

KERB = 7.0  # s: shortly before the front wheels are over it
SCENES = (
    ("slalom", 0.005, partial(varied_cars, "slalom", 0)),
    ("lane change", 0.01, partial(varied_cars, "double_lane_change_replay", 0)),
    ("slalom, tables", 0.005, partial(varied_cars, "slalom", 10)),
    ("lane change, tables", 0.01, partial(varied_cars, "double_lane_change_replay", 10)),
    ("slalom, flexible frame", 0.005, partial(varied_cars, "slalom", 3)),
    ("kerb test, flexible frame", 0.01, partial(one_after_another, partial(kerb_test.build, 3), KERB)),
    ("double four-bar", 0.01, partial(varied_four_bars, 2)),
    ("40 windows", 0.01, partial(varied_four_bars, 40)),
    ("flexible four-bar", 0.01, partial(one_after_another, assembly_defect_four_bar.build, 1.0)),
)
WITH_LINKS = SCENES[:2]
COLUMNS = {
    "scene": "",
    "step_ms": "g",
    "way": "",
    "us_a_step": ".1f",
    "ratio": ".2f",
    "ratio_to_older": ".2f",
    "cars_in_real_time_a_core": ".0f",
    "steps_alone": "d",
    "kilobytes_a_car": ".0f",
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("throughput", __doc__)
    parser.add_argument("--older", type=Path, metavar="FOLDER", help="a clone at the commit to compare with")
    parser.add_argument("--rounds", type=int, default=3, metavar="N", help="runs of each way (default: 3)")
    options = parser.parse_args(arguments)

    def work() -> int:
        scenes = SCENES if options.older is None else WITH_LINKS
        rows = [row for scene in watched(scenes) for row in rows_of(*scene, rounds=options.rounds, older=options.older)]
        print_table(rows, {key: form for key, form in COLUMNS.items() if key in rows[0]})
        print(f"\nA second of {THOUSAND} cars, computed from the steps above\n{thousand(rows)}")
        save_rows(options.json, "throughput", rows)
        return 0

    return run_command(work, (KernelError,))


def rows_of(
    scene: str, h: float, make: partial[tuple[System, Start]], *, rounds: int, older: Path | None
) -> list[dict[str, Any]]:
    """Rows of a scene, beside the cars of another commit where they are asked for."""
    if older is None:
        return measure(scene, h, make, rounds=rounds)
    with older_cars(older, make.args[0], h, SECONDS, CARS) as cars:
        return measure(scene, h, make, rounds=rounds, older=cars)


if __name__ == "__main__":
    sys.exit(main())
