"""Iterations, factorizations, solves and instructions of a step of a scene."""

import re
import shutil
import subprocess
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

from benchmarks.car.step_scenes import Scene, command_of
from benchmarks.shared.figures import between, rows_of
from benchmarks.shared.pages import Row, table

_COLLECTED = re.compile(r"Collected : (\d+)")
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
