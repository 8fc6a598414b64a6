"""Steps of scenes by the kernels of this checkout and of another one, in turn on the same machine."""

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

from benchmarks.car import step_scenes
from benchmarks.car.operations import executed
from benchmarks.car.step_scenes import SOURCE, Scene
from benchmarks.shared.command import watched
from mbs.kernel import build

ROOT = Path(__file__).parents[2]
_COMMANDS = """
import json, runpy, sys
from pathlib import Path
here = runpy.run_path(sys.argv[1])
program, wanted, steps = Path(sys.argv[2]), json.loads(sys.argv[3]), int(sys.argv[4])
commands = {}
for scene in here["SCENES"]:
    if [scene.name, scene.step] in wanted:
        folder = program.parent / str(len(commands))
        folder.mkdir()
        key = f"{scene.name} {scene.step}"
        commands[key] = here["command_of"](scene._replace(steps=steps or scene.steps), program, folder)
print("\\n" + json.dumps(commands))
"""
"""Scenes of `step_scenes` of this checkout, made by the packages of another one."""


def commands_of(checkout: Path, scenes: Sequence[Scene], folder: Path, steps: int) -> dict[str, list[str]]:
    """The program of `SOURCE` with the kernel of a checkout, and its arguments for each scene.

    Parameters
    ----------
    checkout : Path
        Folder of a working tree.
    scenes : sequence of Scene
        Scenes of `step_scenes.SCENES`; one that the other packages cannot make is an error.
    folder : Path
        Empty folder for program and files.
    steps : int
        Number of steps of each scene; 0: its own number.

    Raises
    ------
    RuntimeError
        It is not a working tree of this project, its kernel does not compile, or its packages do not make the scenes.
    """
    kernel, program = checkout / "mbs" / "kernel", folder / "run_system"
    sources = build.sources(lanes=False, kernel=kernel)
    if not sources:
        raise RuntimeError(
            f"{checkout} is not a working tree of this project: it has no mbs/kernel/src; git worktree add FOLDER "
            "COMMIT makes one."
        )
    label = f"the program that repeats steps, with the kernel of {checkout},"
    include = (kernel / "include",)
    build.compile_c([SOURCE, *sources], build.host_target(), program, include=include, what=label, shared=False)
    scene_steps = json.dumps([[scene.name, scene.step] for scene in scenes])
    command = [sys.executable, "-c", _COMMANDS, step_scenes.__file__, str(program), scene_steps, str(steps)]
    environment = os.environ | {"PYTHONPATH": str(checkout)}
    process = subprocess.run(command, cwd=checkout, env=environment, capture_output=True, text=True)
    if process.returncode != 0:
        last_line = process.stderr.strip().rsplit("\n", 1)[-1]
        raise RuntimeError(f"The packages of {checkout} do not make these scenes: {last_line}")
    record: dict[str, list[str]] = json.loads(process.stdout.rsplit("\n", 2)[-2])
    return record


def measure(
    other: Path, scenes: Sequence[Scene], rounds: int, repeats: int, counted: bool, steps: int = 0
) -> Iterator[dict[str, Any]]:
    """A row for each scene that both have: microseconds a step, their ratio, and what a step takes, here and there.

    `least` and `most` are the ratios of single rounds. Both use the loops of their kernels.

    Parameters
    ----------
    other : Path
        Folder of the other checkout.
    scenes : sequence of Scene
        Scenes of `step_scenes.SCENES`.
    rounds : int
        Each measures both, one after the other; the ratio is the median of the ratios of all rounds.
    repeats : int
        Runs of which a round takes the least time.
    counted : bool
        Instructions and operations too, if valgrind and objdump are installed.
    steps : int
        Number of steps of each scene; 0: its own number.
    """
    with tempfile.TemporaryDirectory() as folder:
        commands = {}
        for name, checkout in (("there", other), ("here", ROOT)):  # a wrong folder is refused before anything compiles
            Path(folder, name).mkdir()
            commands[name] = commands_of(checkout.resolve(), scenes, Path(folder, name), steps)
        for scene in watched([s for s in scenes if f"{s.name} {s.step}" in commands["there"]]):
            key = f"{scene.name} {scene.step}"
            two_sides = [Side(name, commands[name][key]) for name in ("here", "there")]
            yield row_of(scene, two_sides, steps or scene.steps, rounds, repeats, counted)


class Side(NamedTuple):
    """A way to make the same steps: its name, the program that repeats them with its arguments, generated code."""

    name: str
    command: list[str]
    code: tuple[str, ...] = ()


def row_of(scene: Scene, both: Sequence[Side], steps: int, rounds: int, repeats: int, counted: bool) -> dict[str, Any]:
    """A row of two ways that make steps in turn; other arguments as in `measure`."""
    times: list[list[float]] = [[], []]
    counts: list[list[int]] = [[], []]
    for k in range(2 * rounds):
        side = (k + k // 2) % 2  # here, there, there, here: a drift of the machine's pace is on both sides
        command = [*both[side].command, str(repeats), *both[side].code]
        output = subprocess.run(command, capture_output=True, text=True, check=True).stdout.split()
        if output[0] != "0":
            raise RuntimeError(f"A step of the scene {scene.name!r} was refused (status {output[0]}).")
        counts[side] = [int(count) for count in output[1:4]]
        times[side].append(1e6 * float(output[4]) / steps)
    row: dict[str, Any] = {"scene": scene.name, "step, ms": 1e3 * scene.step}
    names = [side.name for side in both]
    for side, name in enumerate(names):
        row[f"us {name}"] = round(min(times[side]), 3)
    ratios = [a / b for a, b in zip(*times, strict=True)]
    row |= {"ratio": round(median(ratios), 3), "least": round(min(ratios), 3), "most": round(max(ratios), 3)}
    for side, name in enumerate(names):
        row |= {
            f"{what} {name}": round(n / steps, 3)
            for what, n in zip(("iterations", "solves"), counts[side][::2], strict=True)
        }
    if counted:
        for name, command, code in both:
            with_steps, without = (executed([*command[:5], n, "1", *code]) for n in (str(steps), "0"))
            for what, total, start in zip(("instructions", "operations"), with_steps, without, strict=True):
                row[f"{what} {name}"] = None if total is None or start is None else round((total - start) / steps)
    return row
