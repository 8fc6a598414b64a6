"""Tables and figures of the paper, computed with this engine: ``python -m benchmarks.paper PART``.

Double four-bar (Table 1), PUMA (Table 2), four-bar with assembly defect (section 3.3, Figure 5), and the car on the
kerb, with a smooth guide or one from measured accelerations. The paper's car has 293 variables, 239 constraints and 65
modes; its 15 s take 48 s, with 2 iterations on average and at most 3.
"""

import sys
from argparse import Namespace
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import mbs
from benchmarks.paper import assembly_defect, double_four_bar, kerb, measured_guides, puma
from benchmarks.shared.coarse_runs import expected_errors
from benchmarks.shared.command import Part, run, watched
from benchmarks.shared.pages import Row
from benchmarks.shared.tables import plain_table
from mbs.scenes import kerb_test
from mbs.scenes import puma as puma_scene
from mbs.vehicle import Fidelity

QUICK = {"quick": (False, "a part of it, once")}


@expected_errors()
def _four_bar(options: Namespace) -> list[dict[str, Any]]:
    windows = double_four_bar.WINDOWS[:1] if options.quick else double_four_bar.WINDOWS
    return double_four_bar.measure_all(windows, options.repeats)


def _puma(options: Namespace) -> list[dict[str, Any]]:
    system, methods = mbs.compile(puma_scene.build()), puma.METHODS[:1] if options.quick else puma.METHODS
    runs = [(method, h) for method in methods for h in puma.STEPS]
    rows = [{"table": "methods", **puma.measure(system, *run)} for run in watched(runs)]
    stages = [] if options.quick else puma.errors_by_stage(system, methods[0])
    return rows + [{"table": "large steps in one stage", **row} for row in stages]


@expected_errors()
def _defect(options: Namespace) -> list[dict[str, Any]]:
    cases = assembly_defect.CASES[:1] if options.quick else assembly_defect.CASES
    bars = [{"table": "bars", **assembly_defect.measure(case)} for case in watched(cases)]
    return bars + [{"table": "largest moments, N m", **assembly_defect.peaks(r)} for r in assembly_defect.RADII]


def _text_of_both(rows: Sequence[Row], blocks: Callable[[Sequence[Row]], Mapping[str, str]]) -> str:
    """Tables of the page, and below them the rows of the second table, which the page has as text."""
    others = [row for row in rows if row["table"] != rows[0]["table"]]
    return "\n\n".join([*blocks(rows).values(), *([plain_table(others)] if others else [])])


def _kerb(options: Namespace) -> list[dict[str, Any]]:
    runs = [(Fidelity.of(name), h) for name in options.only for h in options.steps]
    return [kerb.measure(*run, options.repeats) for run in watched(runs)]


PARTS = {
    "four-bar": Part(
        "the N-four-bar for ten seconds through ten singular positions, against the exact reduction to one angle",
        _four_bar,
        options=QUICK | {"repeats": (double_four_bar.REPEATS, "timed runs of a row")},
        pages=("speed_and_accuracy.md",),
        blocks=double_four_bar.four_bar_blocks,
        chart=double_four_bar.draw,
    ),
    "puma": Part(
        "the PUMA 560 whose hand is pinned and released; where the error of large steps comes from",
        _puma,
        options=QUICK,
        pages=("speed_and_accuracy.md",),
        blocks=puma.puma_blocks,
        words=lambda rows: _text_of_both(rows, puma.puma_blocks),
    ),
    "defect": Part(
        "section forces of the four-bar with assembly defect, against geometrically exact beams",
        _defect,
        options=QUICK,
        pages=("flexible.md",),
        blocks=assembly_defect.defect_blocks,
        words=lambda rows: _text_of_both(rows, assembly_defect.defect_blocks),
        chart=assembly_defect.draw,
    ),
    "kerb": Part(
        "the car on the kerb: size, iterations, time; peaks of the bending moments and what is left of them",
        _kerb,
        names=kerb.FIDELITIES,
        options={"steps": ((kerb_test.STEP,), "s"), "repeats": (3, "timed runs of a row")},
    ),
    "guides": Part(
        "the same driven by four accelerometers, as in the paper's experiment; means over seeds",
        lambda options: measured_guides.measure(options.seeds),
        options={"seeds": (3, "noises of a row")},
        pages=("flexible_car.md",),
        blocks=measured_guides.driving_blocks,
    ),
}

main = partial(run, "paper", __doc__, PARTS)

if __name__ == "__main__":
    sys.exit(main())
