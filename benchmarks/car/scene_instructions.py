"""Instructions of a step of a scene, by the kernel alone in a small program."""

import re
import shutil
import subprocess
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from benchmarks.car import manoeuvres
from benchmarks.shared.figures import between, rows_of
from benchmarks.shared.pages import Row, table
from hosts.driving.manoeuvre import Manoeuvre
from mbs import Simulation, System, compile
from mbs.kernel import build
from mbs.scenes import bricard, double_four_bar, flyball, kerb_test, prototype_car, spatial_chain

_COLLECTED = re.compile(r"Collected : (\d+)")
SOURCE = Path(__file__).parents[1] / "shared" / "c" / "run_system.c"
PAGE = "docs/speed.md"
MAX_RATIO = 1.03
"""Ratio to the table of the page above which a step is dearer."""


@cache
def find_valgrind() -> str | None:
    """The program valgrind; None if it is not installed."""
    return shutil.which("valgrind")


def count_instructions(
    command: Sequence[str], profile: Path = Path("/dev/null"), options: Sequence[str] = ()
) -> int | None:
    """Instructions of a program, the same on a busy machine and on an idle one; None without valgrind.

    `profile`: file that callgrind writes; `options`: options of callgrind.

    Raises `RuntimeError` if valgrind did not say how many.
    """
    valgrind = find_valgrind()
    if valgrind is None:
        return None
    run = [valgrind, "--tool=callgrind", f"--callgrind-out-file={profile}", *options, *command]
    process = subprocess.run(run, capture_output=True, text=True, check=True)
    result = _COLLECTED.search(process.stderr)
    if result is None:
        raise RuntimeError(f"{valgrind} did not say how many instructions it has counted.")
    return int(result[1])


class Scene(NamedTuple):
    """The first steps of a motion, which are counted."""

    name: str
    step: float
    """s."""
    steps: int
    """Number of steps."""
    system: Callable[[], System]
    """Compiles the System."""
    manoeuvre: str = ""
    """Name of the manoeuvre that gives a car its start and inputs; empty: none."""


def _compile_flexible() -> System:
    return compile(prototype_car.build(fidelity=3))


def _compile_rigid() -> System:
    return manoeuvres.system_of("slalom")


def _compile_tables() -> System:
    return compile(prototype_car.build(fidelity=10))


SCENES = (
    Scene("double four-bar", 0.03, 330, lambda: compile(double_four_bar.build())),
    Scene("40 windows", 0.01, 200, lambda: compile(double_four_bar.build(windows=40))),
    Scene("Bricard's mechanism", 0.01, 300, lambda: compile(bricard.build())),
    Scene("flyball governor", 0.01, 300, lambda: compile(flyball.build())),
    Scene("spatial chain", 0.01, 200, lambda: compile(spatial_chain.build())),
    Scene("lane change", 0.01, 500, _compile_rigid, "double_lane_change_replay"),
    Scene("lane change", 0.002, 500, _compile_rigid, "double_lane_change_replay"),
    Scene("slalom", 0.005, 500, _compile_rigid, "slalom"),
    Scene("launch and brake", 0.01, 500, _compile_rigid, "launch_and_brake"),
    Scene("full lock", 0.01, 500, _compile_rigid, "full_lock"),
    Scene("drop", 0.002, 500, _compile_rigid, "drop"),
    Scene("lane change, tables", 0.01, 500, _compile_tables, "double_lane_change_replay"),
    Scene("slalom, tables", 0.005, 500, _compile_tables, "slalom"),
    Scene("slalom, flexible frame", 0.005, 100, _compile_flexible, "slalom"),
    Scene("drop, flexible frame", 0.002, 200, _compile_flexible, "drop"),
    Scene("kerb test, flexible frame", 0.01, 100, lambda: compile(kerb_test.build(3))),
    Scene("kerb test, load paths", 0.01, 100, lambda: compile(kerb_test.build(2))),
)


def compile_program(folder: Path) -> Path:
    """The program that repeats steps."""
    program, label = folder / "run_system", "the program that repeats steps"
    sources, include = [SOURCE, *build.sources(lanes=False)], (build.HERE / "include",)
    build.compile_c(sources, build.host_target(), program, include=include, what=label, shared=False)
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
    command_without_steps = [*command[:-1], "0"]
    output = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    status, *counts = map(int, output.split())
    if status != 0:
        raise RuntimeError(f"A step of the scene {scene.name!r} was refused (status {status}).")
    total, start_count = count_instructions(command), count_instructions(command_without_steps)
    row: dict[str, Any] = {"scene": scene.name, "step_ms": 1e3 * scene.step, "steps": scene.steps}
    row |= {k: n / scene.steps for k, n in zip(("iterations", "factorizations", "solves"), counts, strict=True)}
    result = None if total is None or start_count is None else round((total - start_count) / scene.steps)
    return row | {"instructions": result}


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


def compare_with_page(rows: Sequence[Row], page: str) -> list[str]:
    """A sentence for each scene that takes over 3 % more than in the table of a page; factorizations count without
    valgrind.
    """
    written = {(row["scene"], row["step, ms"]): row for row in rows_of(between(page, "instructions"))}
    lines = []
    for row in rows:
        before = written.get((row["scene"], f"{row['step_ms']:g}"))
        if before is None:
            continue
        counted = row["instructions"] is not None and before["instructions"] != "–"
        quantity = "instructions" if counted else "factorizations"
        ratio = row[quantity] / float(before[quantity].replace(",", ""))
        if ratio > MAX_RATIO:
            lines.append(
                f"{row['scene']}, {row['step_ms']:g} ms: {quantity} {100.0 * (ratio - 1.0):.1f} % more a step."
            )
    return lines
