"""What a step costs: ``python -m benchmarks.cost PART``: instructions, growth, worst steps, many cars a core."""

import sys
import tempfile
from argparse import Namespace
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from benchmarks.car import against_checkout, generated_code, lanes, real_time, scene_instructions, step_scenes
from benchmarks.methods import cost_growth
from benchmarks.shared.command import Part, run, watched
from benchmarks.shared.figures import read
from benchmarks.shared.pages import Row


def _scenes_of(options: Namespace) -> list[step_scenes.Scene]:
    return [scene for scene in step_scenes.SCENES if scene.name in options.only]


def _instructions(options: Namespace) -> list[dict[str, Any]]:
    with tempfile.TemporaryDirectory() as folder:
        program = step_scenes.compile_program(Path(folder))
        return [scene_instructions.measure(scene, program, Path(folder)) for scene in watched(_scenes_of(options))]


def _increases(rows: Sequence[Row], options: Namespace) -> list[str]:
    return scene_instructions.compare_with_page(rows, read(scene_instructions.PAGE)) if options.compare else []


def _turns(options: Namespace) -> list[dict[str, Any]]:
    if options.other is None:
        raise RuntimeError("--other is missing: the folder of the checkout with which steps are timed in turn.")
    counts = options.rounds, options.repeats, options.instructions
    return [*against_checkout.measure(options.other, _scenes_of(options), *counts)]


def _generated(options: Namespace) -> list[dict[str, Any]]:
    return [*generated_code.measure(_scenes_of(options), options.rounds, options.repeats)]


def _growth(options: Namespace) -> list[dict[str, Any]]:
    windows = cost_growth.WINDOWS[:5] if options.quick else cost_growth.WINDOWS
    return cost_growth.measure(windows, 1 if options.quick else options.repeats)


def _throughput(options: Namespace) -> list[dict[str, Any]]:
    scenes = [scene for scene in lanes.SCENES if scene[0] in options.only]
    return [row for scene in watched(scenes) for row in lanes.measure(*scene, rounds=options.rounds)]


SCENES = tuple(dict.fromkeys(scene.name for scene in step_scenes.SCENES))
IN_TURN = {
    "rounds": (7, "each measures both; the ratio is the median of all rounds"),
    "repeats": (5, "runs of which a round takes the least"),
}
PARTS = {
    "instructions": Part(
        "iterations, factorizations and solves of the first steps of scenes, and instructions where valgrind is there",
        _instructions,
        names=SCENES,
        options={"compare": (False, "with the table of the page: over 3 % more is an error")},
        pages=(scene_instructions.PAGE.removeprefix("docs/"),),
        blocks=scene_instructions.instruction_blocks,
        check=_increases,
    ),
    "turns": Part(
        "steps of scenes by this checkout and by another one in turn: times, their ratio, counts",
        _turns,
        names=SCENES,
        options=IN_TURN
        | {
            "other": (Path, "folder of the other checkout: a working tree, made by git worktree add"),
            "instructions": (False, "instructions beside the times"),
        },
    ),
    "generated": Part(
        "steps of scenes by the loops of the kernel and by code generated for their Systems, in turn",
        _generated,
        names=SCENES,
        options=IN_TURN,
        pages=("speed.md",),
        blocks=generated_code.blocks,
    ),
    "growth": Part(
        "time, memory and non-zeros of the N-four-bar by N, with exponents",
        _growth,
        options={"quick": (False, "N up to 20, one repeat"), "repeats": (cost_growth.REPEATS, "timed runs of a row")},
        pages=("speed_and_accuracy.md",),
        blocks=cost_growth.growth_blocks,
        chart=cost_growth.draw,
    ),
    "real-time": Part(
        "worst steps of wild driving by fidelity and step, without and with a limit of their iterations",
        real_time.measure,
        options={
            "fmu": (Path, "a native FMU of a car; by default the prototype, built"),
            "seconds": (10.0, "simulated, of each drive, s; an hour each takes a day"),
            "fidelity": (real_time.FIDELITIES, "of the prototype"),
            "step": (real_time.STEPS, "ms"),
            "limit": ((), "of the iterations, instead of none and the usual ones"),
            "seed": (1, "of the driver"),
        },
        pages=("speed.md",),
        blocks=real_time.real_time_blocks,
    ),
    "throughput": Part(
        "slightly different cars and mechanisms, one after the other, in lanes and in the widest lanes on all cores",
        _throughput,
        names=tuple(scene[0] for scene in lanes.SCENES),
        options={"rounds": (3, "of which each part of a run counts by its least")},
        pages=("speed.md",),
        blocks=lanes.lane_blocks,
    ),
}

main = partial(run, "cost", __doc__, PARTS)

if __name__ == "__main__":
    sys.exit(main())
