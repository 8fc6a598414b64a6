"""Instructions of a step of a scene, by the kernel alone in a small program."""

from __future__ import annotations

import subprocess
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from benchmarks.car import manoeuvres
from benchmarks.shared.instructions import instructions
from benchmarks.shared.pages import Row, table
from hosts.driving.manoeuvre import Manoeuvre
from mbs import Simulation, System
from mbs.kernel import build

SOURCE = Path(__file__).parents[1] / "shared" / "c" / "run_system.c"


class Scene(NamedTuple):
    """What is counted: the first `steps` of `step` seconds."""

    name: str
    step: float
    steps: int
    system: Callable[[], System]
    manoeuvre: str = ""


def compiled(folder: Path) -> Path:
    """The program that repeats steps."""
    program, what = folder / "run_system", "the program that repeats steps"
    sources, include = [SOURCE, *build.sources(lanes=False)], (build.HERE / "include",)
    build.compile_c(sources, build.host_target(), program, include=include, what=what, shared=False)
    return program


def command_of(scene: Scene, program: Path, folder: Path) -> list[str]:
    """The program with its arguments; its files are written."""
    system = scene.system()
    files = [folder / name for name in ("system", "state", "inputs")]
    if scene.manoeuvre:
        manoeuvre = manoeuvres.load(scene.manoeuvre)
        parameters, pose = manoeuvres.start_of(manoeuvre, system)
        inputs = input_rows(manoeuvre, system, scene.step * np.arange(scene.steps + 1))
        names = [entry["name"] for entry in system.meta["inputs"]]
        start = Simulation(system, inputs=dict(zip(names, inputs[0], strict=True)), parameters=parameters, pose=pose)
    else:
        inputs, start = np.empty((1, 0)), Simulation(system)
    contents = (system.kernel_bytes(), start.save(), inputs[1:].astype("<f8").tobytes())
    for file, data in zip(files, contents, strict=True):
        file.write_bytes(data)
    return [str(program), *map(str, files), repr(scene.step), str(scene.steps)]


def measure(scene: Scene, program: Path, folder: Path) -> dict[str, Any]:
    """A row of the table."""
    command = command_of(scene, program, folder)
    still = [*command[:-1], "0"]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    status, *counts = map(int, said.split())
    if status != 0:
        raise RuntimeError(f"A step of the scene {scene.name!r} was refused (status {status}).")
    whole, before = instructions(command), instructions(still)
    row: dict[str, Any] = {"scene": scene.name, "step_ms": 1e3 * scene.step, "steps": scene.steps}
    row |= {k: n / scene.steps for k, n in zip(("iterations", "factorizations", "solves"), counts, strict=True)}
    found = None if whole is None or before is None else round((whole - before) / scene.steps)
    return row | {"instructions": found}


def input_rows(manoeuvre: Manoeuvre, system: System, times: np.ndarray) -> np.ndarray:
    """Values of all inputs of a System at these times, a row each."""
    signals = manoeuvres.inputs_of(manoeuvre, system)
    columns = []
    for entry in system.meta["inputs"]:
        signal = signals.get(entry["name"], entry["start"])
        columns.append(np.interp(times, *signal) if isinstance(signal, tuple) else np.full(len(times), signal))
    return np.array(columns, float).T


def instruction_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """What a step costs in iterations, factorizations and instructions."""
    lines = [r | {"step, ms": f"{r['step_ms']:g}"} for r in rows]
    columns = {"scene": "", "step, ms": "", "iterations": ".3f", "factorizations": ".3f", "solves": ".2f"}
    return {"instructions": table(lines, columns | {"instructions": ",d"})}
