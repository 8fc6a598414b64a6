"""Where methods break: ``python -m benchmarks.stability [--scene NAME ...] [--json FILE] [--charts DIR] [--quick]``.

A map over step and penalty (or its counterpart) for each method and scene: fine, wrong, refused or diverged.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ali3.running import run_command
from benchmarks.methods.pages import stability_blocks
from benchmarks.methods.stability import ENERGY, WRONG, explain, measure
from benchmarks.methods.stability_chart import draw
from benchmarks.methods.stability_margins import margins
from benchmarks.references.cases import CASES
from benchmarks.shared.command import parser_of, save_rows
from benchmarks.shared.pages import print_blocks
from benchmarks.shared.warned import wrong_on_purpose

QUICK = ("double_four_bar",)
WHY = {  # one line a classical method; the table adds rank and time as found
    "index-1 augmented Lagrangian, projected": "explicit Runge-Kutta on accelerations: the penalised rows are met only "
    "in the limit, and stiff constraint oscillators bound the step; passes singular and redundant positions",
    "index-1 Lagrange, Baumgarte": "the bordered matrix needs Phi_q of full row rank: exactly singular where rows are "
    "redundant, and wherever a step lands on a singular position; a factor beyond about 2/h makes the rows themselves "
    "diverge",
    "index-1 minimum norm, Baumgarte": "the cut between kept and dropped singular values is a guess; near a singular "
    "position a kept small one makes accelerations explode, a dropped real one lets the rows drift",
    "velocity transformation": "the fixed independent coordinates stop being independent at their dead point: the "
    "block of Phi_q for the dependent ones loses its rank",
    "penalty": "rows are springs: soft ones let the mechanism leave its branch at singular positions, stiff ones are "
    "beyond the stability limit of the explicit rule",
}


@wrong_on_purpose()
def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("stability", __doc__)
    parser.add_argument("--scene", action="append", choices=list(CASES), help="a scene; may be given again")
    parser.add_argument("--charts", type=Path, metavar="DIR", help="draw a PNG per scene")
    parser.add_argument("--quick", action="store_true", help="one scene, few points")
    options = parser.parse_args(arguments)
    scenes = options.scene or (
        QUICK if options.quick else [s for s in CASES if s not in ("pendulum_1000s", "four_bar_200")]
    )
    rows: list[dict[str, Any]] = []
    for scene in scenes:
        begin = time.perf_counter()
        part = measure(scene, options.quick)
        rows += part
        print(f"{scene}: {len(part)} runs in {time.perf_counter() - begin:.0f} s", flush=True)
        if options.charts is not None:
            draw(
                part,
                f"{CASES[scene].title} (whole motion, {CASES[scene].end:g} s)",
                options.charts / f"stability_{scene}.png",
            )
    found = {"margins": margins(rows), "why": WHY, "classical": explain(rows)}
    blocks = stability_blocks([{"meta": found, "rows": rows}])
    print_blocks({name: text for name, text in blocks.items() if "charts" not in name})
    save_rows(
        options.json,
        "stability",
        rows,
        fine=f"position within {WRONG:g} of the extent, energy within {ENERGY:g} of the largest kinetic energy",
        window="the whole motion of the scene; smaller steps than its budget allows are left out",
        **found,
    )
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
