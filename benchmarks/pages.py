"""Write measured tables into the pages of `docs/`: ``python -m benchmarks.pages --work FILE --stability FILE ...``.

A table stands between ``<!-- begin NAME -->`` and ``<!-- end NAME -->``; the text around it is written by hand.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ali3.files import write_text
from ali3.running import run_command
from benchmarks.car.fidelity import choice_blocks
from benchmarks.car.fmu_pages import BLOCKS
from benchmarks.car.pages import car_blocks, function_blocks, instruction_blocks
from benchmarks.car.speed_pages import peer_blocks, real_time_blocks, throughput_blocks
from benchmarks.car.trust import COLUMNS, trust_blocks
from benchmarks.methods.pages import (
    control_blocks,
    dissipative_blocks,
    growth_blocks,
    honesty_blocks,
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
DATA = ("work", "stability", "growth", "four-bar", "puma", "dissipative", "honesty", "control", "study", "car", "trust")


def _read(files: Sequence[Path]) -> list[dict[str, Any]]:
    return [json.loads(f.read_text(encoding="utf-8")) for f in files]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.pages", description=__doc__)
    for name in (*DATA, "instructions", "functions", "throughput", "car-peers", "real-time", "fidelity", *BLOCKS):
        parser.add_argument(f"--{name}", type=Path, nargs="+", default=[], metavar="FILE", help=f"JSON of {name}")
    parser.add_argument("--docs", type=Path, default=DOCS, help="folder of the pages")
    o = parser.parse_args(arguments)
    files = (_read(getattr(o, name.replace("-", "_"))) for name in DATA)
    work, stability, growth, four_bar, puma, dissipative, honesty, control, study, car, trust = files
    blocks: dict[str, str] = {}
    if work:
        blocks |= work_blocks([r for f in work for r in f["rows"]]) | {"machine work": machine(work[0]["meta"])}
    if stability:
        blocks |= stability_blocks(stability) | {"machine stability": machine(stability[0]["meta"])}
    if growth:
        blocks |= growth_blocks(growth[0]) | {"machine growth": machine(growth[0]["meta"])}
    if four_bar:
        blocks |= four_bar_blocks(four_bar[0])
    if puma:
        blocks |= puma_blocks(puma[0])
    if dissipative:
        blocks |= dissipative_blocks({"rows": [r for f in dissipative for r in f["rows"]]})
    if control:
        blocks |= control_blocks([r for f in control for r in f["rows"]])
        blocks |= {"machine control": machine(control[0]["meta"])}
    if honesty:
        blocks |= honesty_blocks([r for f in honesty for r in f["rows"]])
        blocks |= {"machine honesty": machine(honesty[0]["meta"])}
    if study:
        blocks |= study_blocks([r for f in study for r in f["rows"]]) | {"machine study": machine(study[0]["meta"])}
    if car:
        blocks |= car_blocks(car[0]["rows"]) | {"machine car": machine(car[0]["meta"])}
    if trust:
        blocks |= trust_blocks({k: [r for r in trust[0]["rows"] if r["table"] == k] for k in COLUMNS})
    if o.instructions:
        blocks |= instruction_blocks(_read(o.instructions)[0]["rows"])
    if o.functions:
        blocks |= function_blocks(_read(o.functions)[0]["rows"])
    if o.throughput:
        blocks |= throughput_blocks(_read(o.throughput))
    if o.car_peers:
        blocks |= peer_blocks(_read(o.car_peers)[0])
    if o.real_time:
        blocks |= real_time_blocks(_read(o.real_time))
    for name, make in BLOCKS.items():
        if getattr(o, name):
            blocks |= make(_read(getattr(o, name))[0]["rows"])
    if o.fidelity:
        blocks |= choice_blocks(_read(o.fidelity)[0]["rows"])
    for page in PAGES:
        file = o.docs / page
        write_text(file, replace(file.read_text(encoding="utf-8"), blocks))
    print(f"{len(blocks)} tables written")
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
