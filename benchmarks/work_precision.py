"""Error over computing time: ``python -m benchmarks.work_precision PART``: methods, tolerances, other engines."""

import sys
from argparse import Namespace
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from benchmarks import peers
from benchmarks.methods import dissipative, error_control, free_runs, unreduced_models, work_precision
from benchmarks.methods.work_precision_chart import MAX_ERROR, draw
from benchmarks.references.cases import CASES, SLOW, size_of, store
from benchmarks.shared.coarse_runs import expected_errors
from benchmarks.shared.command import Part, report_missing, run, watched
from benchmarks.shared.pages import Row
from benchmarks.shared.tables import plain_table
from mbs.settings.methods import METHOD_TABLE


@expected_errors()
def _charts(options: Namespace) -> list[dict[str, Any]]:
    engines, missing = peers.available()
    for name in missing:
        report_missing(f"{name} is not installed (python -m pip install 'ali3[peers]')")
    repeats = 1 if options.quick else options.repeats
    return [row for scene in options.only for row in work_precision.measure(scene, options.quick, engines, repeats)]


def _draw(rows: Sequence[Row], folder: Path) -> None:
    for scene in dict.fromkeys(row["scene"] for row in rows):
        scene_rows = [row for row in rows if row["scene"] == scene]
        draw(scene_rows, CASES[scene], MAX_ERROR * size_of(scene), folder / f"work_{scene}.png")


def _control(options: Namespace) -> list[dict[str, Any]]:
    tolerances = error_control.QUICK_TOLERANCES if options.quick else error_control.TOLERANCES
    rows: list[dict[str, Any]] = []
    for scene, tolerance in [(scene, tolerance) for scene in options.only for tolerance in tolerances]:
        names = [*error_control.methods_of(scene, tolerance), error_control.CHOSEN]
        repeats = 1 if options.quick else error_control.REPEATS
        scene_rows = [error_control.measure(scene, tolerance, method, repeats) for method in watched(names)]
        error_control.compare(scene_rows)
        rows += scene_rows
    return rows


@expected_errors()
def _dissipative(options: Namespace) -> list[dict[str, Any]]:
    scenes = dissipative.QUICK if options.quick else options.only
    methods = ("ali3p",) if options.quick else dissipative.METHODS
    pairs = [(scene, method) for scene in scenes for method in methods]
    steps = {scene: (0.01,) if options.quick else dissipative.SCENES[scene].steps for scene in scenes}
    return [dissipative.measure(*pair, h) for pair in watched(pairs) for h in steps[pair[0]]]


def _free(options: Namespace) -> list[dict[str, Any]]:
    steps = options.steps // 100 if options.quick else options.steps
    return free_runs.rows(watched(list(options.only)), options.methods, steps)


def _motions(options: Namespace) -> None:
    for name in watched(options.only):
        store(name)


PARTS = {
    "charts": Part(
        "every method over a range of steps and tolerances against exact motions, beside other engines",
        _charts,
        names=tuple(CASES),
        options={
            "quick": (False, "two steps and one repeat of each scene"),
            "repeats": (work_precision.REPEATS, "timed runs of a row"),
        },
        pages=("speed_and_accuracy.md",),
        blocks=work_precision.work_blocks,
        chart=_draw,
    ),
    "control": Part(
        "runs to a tolerance by every method that may be chosen and by the choice itself",
        _control,
        names=error_control.SCENES,
        options={"quick": (False, "one tolerance, one repeat")},
        pages=("speed_and_accuracy.md",),
        blocks=error_control.control_blocks,
    ),
    "dissipative": Part(
        "flexible scenes and the car, which have no exact motion: fine, wrong, or refused with a reason",
        _dissipative,
        names=tuple(dissipative.SCENES),
        options={"quick": (False, f"{' and '.join(dissipative.QUICK)} with the default method and one step")},
        pages=("stability.md",),
        blocks=dissipative.dissipative_blocks,
    ),
    "free": Part(
        "each joint and each force in a free mechanism: energy, teeth and angles over many steps",
        _free,
        names=tuple(free_runs.MECHANISMS),
        options={
            "quick": (False, "a hundredth of the steps"),
            "steps": (free_runs.STEPS, "of each run"),
            "methods": ([*METHOD_TABLE], "that run them"),
        },
        pages=("stability.md",),
        blocks=free_runs.blocks,
        chart=free_runs.draw,
    ),
    "motions": Part(
        "write the exact motions that take long, by minimum-norm accelerations under DOP853 or Radau",
        _motions,
        names=SLOW,
        rows=False,
    ),
    "naive": Part(
        "what models without savings cost: twelve coordinates a body, a row for every equation of a joint",
        lambda options: [
            unreduced_models.measure(scene, options.repeats) for scene in watched(list(unreduced_models.SCENES))
        ],
        options={"repeats": (3, "timed runs of a row")},
        pages=("flexible_car.md",),
        blocks=lambda rows: {"naive": unreduced_models.size_table(rows)},
        words=plain_table,
    ),
}

main = partial(run, "work_precision", __doc__, PARTS)

if __name__ == "__main__":
    sys.exit(main())
