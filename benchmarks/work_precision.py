"""Error against time: ``python -m benchmarks.work_precision [--scene NAME ...] [--json FILE] [--charts DIR]``.

Every method over a range of steps, and under error control over a range of tolerances, against the exact motion, one
chart a scene; Drake, Exudyn, MuJoCo and Pinocchio in the same run when they are installed, and the ratio of our time to
the best of theirs at equal error.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ali3.running import run_command
from benchmarks import peers
from benchmarks.baselines.run import LANGUAGE
from benchmarks.methods.work_precision import QUICK_SCENES, REPEATS, compare, measure
from benchmarks.methods.work_precision_chart import draw
from benchmarks.references.cases import CASES, SHARED, size_of
from benchmarks.shared.command import parser_of, save_rows
from benchmarks.shared.tables import print_table
from benchmarks.shared.warned import wrong_on_purpose

LOST = 0.5  # of the motion's extent: beyond it the run has no point on the chart
TABLE = {
    "scene": "",
    "family": "",
    "method": "",
    "h_s": ".4g",
    "rtol": ".0e",
    "position_error_m": ".2e",
    "energy_deviation_J": ".2e",
    "wall_s": ".2e",
    "factorizations": "d",
    "evaluations": "d",
    "ended": "",
}


@wrong_on_purpose()
def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("work_precision", __doc__)
    parser.add_argument("--scene", action="append", choices=list(CASES), help="a scene; may be given again")
    parser.add_argument("--charts", type=Path, metavar="DIR", help="draw a PNG per scene")
    parser.add_argument("--quick", action="store_true", help="two scenes, two steps, one repeat")
    parser.add_argument(
        "--repeats", "--rounds", type=int, default=REPEATS, metavar="N", help=f"timed runs per row; default: {REPEATS}"
    )
    options = parser.parse_args(arguments)
    if options.quick:
        options.repeats = 1
    scenes = options.scene or (QUICK_SCENES if options.quick else tuple(CASES))
    engines, missing = peers.available()
    for name in missing:
        print(f"{name} is not installed: its curves are left out (python -m pip install 'ali3[peers]')")
    rows: list[dict[str, Any]] = []
    ratios: list[dict[str, Any]] = []
    for scene in scenes:
        part = measure(scene, options.quick, engines, options.repeats)
        rows += part
        print(f"\n{CASES[scene].title}; extent of the motion {size_of(scene):.3g} {CASES[scene].unit}", flush=True)
        print_table(part, {k: v for k, v in TABLE.items() if k != "scene"})
        if engines and scene in SHARED:
            lines = compare(rows, scene)
            ratios += lines
            print("\nours / best peer at equal error, interpolated along the curves")
            form = {
                "error_m": ".0e",
                "ours": "",
                "ours_ms": ".3g",
                "peer": "",
                "peer_ms": ".3g",
                "ratio": ".3g",
                "ahead": "",
            }
            print_table(lines, form)
        if options.charts is not None:
            draw(part, CASES[scene], LOST * size_of(scene), options.charts / f"work_{scene}.png")
    save_rows(
        options.json,
        "work_precision",
        rows,
        repeats=options.repeats,
        warm_up=1,
        wall="median over repeats through all rows of a scene, time of the steps alone",
        languages={"kernel": "C", "classical": LANGUAGE} | dict.fromkeys(engines, "C++"),
        peers={name: engine.VERSION for name, engine in engines.items()},
        missing_peers=missing,
        scenes={s: CASES[s].title for s in scenes},
        ratios=ratios,
    )
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
