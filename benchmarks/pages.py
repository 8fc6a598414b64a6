"""Write measured tables into the pages of `docs/`: ``python -m benchmarks.pages --work FILE --stability FILE ...``.

A table stands between ``<!-- begin NAME -->`` and ``<!-- end NAME -->``; the text around it is written by hand.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from ali3.files import write_text
from ali3.running import run_command
from benchmarks.car.fidelity import choice_blocks
from benchmarks.car.fmu_pages import fmu_blocks, plant_blocks, wasm_blocks
from benchmarks.car.pages import car_blocks, function_blocks, instruction_blocks
from benchmarks.car.speed_pages import peer_blocks, real_time_blocks, throughput_blocks
from benchmarks.car.trust import COLUMNS, trust_blocks
from benchmarks.methods.pages import (
    control_blocks,
    dissipative_blocks,
    growth_blocks,
    honesty_blocks,
    machines_blocks,
    stability_blocks,
    work_blocks,
)
from benchmarks.methods.study_pages import study_blocks
from benchmarks.paper.pages import four_bar_blocks, puma_blocks
from benchmarks.shared.pages import DOCS, machine, replace

PAGES = (
    *("speed_and_accuracy.md", "stability.md", "accuracy.md", "scale.md"),
    *("speed.md", "fmu.md", "trust.md", "flexible_car.md", "stepping.md"),
)
Files = list[dict[str, Any]]


def _rows(files: Files) -> list[dict[str, Any]]:
    return [row for file in files for row in file["rows"]]


def _with_machine(name: str, make: Callable[[Files], dict[str, str]]) -> Callable[[Files], dict[str, str]]:
    """Tables, and where they were measured."""
    return lambda files: make(files) | {f"machine {name}": machine(files[0]["meta"])}


def _trust(files: Files) -> dict[str, str]:
    return trust_blocks({k: [r for r in files[0]["rows"] if r["table"] == k] for k in COLUMNS})


MAKERS: dict[str, Callable[[Files], dict[str, str]]] = {
    "work": _with_machine("work", lambda files: work_blocks(_rows(files))),
    "stability": _with_machine("stability", stability_blocks),
    "growth": _with_machine("growth", lambda files: growth_blocks(files[0])),
    "four-bar": lambda files: four_bar_blocks(files[0]),
    "puma": lambda files: puma_blocks(files[0]),
    "dissipative": lambda files: dissipative_blocks({"rows": _rows(files)}),
    "control": _with_machine("control", lambda files: control_blocks(_rows(files))),
    "honesty": _with_machine("honesty", lambda files: honesty_blocks(_rows(files))),
    "honesty-machines": _with_machine("honesty machines", machines_blocks),
    "study": _with_machine("study", lambda files: study_blocks(_rows(files))),
    "car": _with_machine("car", lambda files: car_blocks(files[0]["rows"])),
    "trust": _trust,
    "instructions": lambda files: instruction_blocks(files[0]["rows"]),
    "functions": lambda files: function_blocks(files[0]["rows"]),
    "throughput": throughput_blocks,
    "car-peers": lambda files: peer_blocks(files[0]),
    "real-time": real_time_blocks,
    "fidelity": lambda files: choice_blocks(files[0]["rows"]),
    "fmu": lambda files: fmu_blocks(files[0]["rows"]),
    "wasm": lambda files: wasm_blocks(files[0]["rows"]),
    "plant": lambda files: plant_blocks(files[0]["rows"]),
}
"""Tables by their names, from the files of a command."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.pages", description=__doc__)
    for name in MAKERS:
        parser.add_argument(f"--{name}", type=Path, nargs="+", default=[], metavar="FILE", help=f"JSON of {name}")
    parser.add_argument("--docs", type=Path, default=DOCS, help="folder of the pages")
    o = parser.parse_args(arguments)
    blocks: dict[str, str] = {}
    for name, make in MAKERS.items():
        if files := getattr(o, name.replace("-", "_")):
            blocks |= make([json.loads(f.read_text(encoding="utf-8")) for f in files])
    for page in PAGES:
        file = o.docs / page
        write_text(file, replace(file.read_text(encoding="utf-8"), blocks))
    print(f"{len(blocks)} tables written")
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
