"""What a step costs, in numbers that no load disturbs: ``python -m benchmarks.instructions [--against FILE]``.

Of each scene a C program repeats the first steps in the kernel: Newton iterations, factorizations and solves a step,
and instructions where valgrind is installed. The table of the project is `benchmarks/data/instructions.json`, written
with ``--json``; with ``--against`` the command ends with 1 if a scene takes over 3 % more than in that table. With
``--functions SCENE`` the functions in which the instructions of one scene are, of those of its name the first.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ali3.running import run_command
from benchmarks.car import manoeuvres
from benchmarks.car.scene_instructions import SOURCE, Scene, command_of, measure
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.instructions import by_function
from benchmarks.shared.tables import print_table
from mbs import System, compile
from mbs.kernel import build
from mbs.scenes import bricard, double_four_bar, flyball, kerb_test, prototype_car, spatial_chain

TABLE = Path(__file__).parent / "data" / "instructions.json"
COLUMNS = {
    "scene": "",
    "step_ms": "g",
    "steps": "d",
    "iterations": ".3f",
    "factorizations": ".3f",
    "solves": ".3f",
    "instructions": ",d",
}
LEAST = 0.01
"""Share of the instructions from which on a function is named."""
MOST = 1.03
"""Ratio to the table from which on a step is dearer."""


def _flexible() -> System:
    return compile(prototype_car.build(fidelity=3))


def _car() -> System:
    return manoeuvres.system_of("slalom")


def _tables() -> System:
    return compile(prototype_car.build(fidelity=10))


SCENES = (
    Scene("double four-bar", 0.03, 330, lambda: compile(double_four_bar.build())),
    Scene("40 windows", 0.01, 200, lambda: compile(double_four_bar.build(windows=40))),
    Scene("Bricard's mechanism", 0.01, 300, lambda: compile(bricard.build())),
    Scene("flyball governor", 0.01, 300, lambda: compile(flyball.build())),
    Scene("spatial chain", 0.01, 200, lambda: compile(spatial_chain.build())),
    Scene("lane change", 0.01, 500, _car, "double_lane_change_replay"),
    Scene("lane change", 0.002, 500, _car, "double_lane_change_replay"),
    Scene("slalom", 0.005, 500, _car, "slalom"),
    Scene("launch and brake", 0.01, 500, _car, "launch_and_brake"),
    Scene("full lock", 0.01, 500, _car, "full_lock"),
    Scene("drop", 0.002, 500, _car, "drop"),
    Scene("lane change, tables", 0.01, 500, _tables, "double_lane_change_replay"),
    Scene("slalom, tables", 0.005, 500, _tables, "slalom"),
    Scene("slalom, flexible frame", 0.005, 100, _flexible, "slalom"),
    Scene("drop, flexible frame", 0.002, 200, _flexible, "drop"),
    Scene("kerb test, flexible frame", 0.01, 100, lambda: compile(kerb_test.build(3))),
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; 1 if a step is dearer than in the table."""
    parser = parser_of("instructions", __doc__)
    parser.add_argument("--against", type=Path, metavar="FILE", help="table that steps are compared with")
    names = list(dict.fromkeys(scene.name for scene in SCENES))
    parser.add_argument("--functions", choices=names, metavar="SCENE", help="where the instructions of a scene are")
    options = parser.parse_args(arguments)

    def work() -> int:
        with tempfile.TemporaryDirectory() as folder:
            program = Path(folder) / "run_system"
            include = (build.HERE / "include",)
            target, what = build.host_target(), "the program that repeats steps"
            sources = [SOURCE, *build.sources(lanes=False)]
            if options.functions is not None:
                scene = next(scene for scene in SCENES if scene.name == options.functions)
                command = build.compiler_command(sources, target, program, include=include, shared=False)
                subprocess.run([part for part in command if part != "-s"], check=True, env=build.compiler_environment())
                functions = shares(scene, program, Path(folder))
                print_table(functions, {"function": "", "share": ".0%"})
                save_rows(options.json, "functions", functions, scene=scene.name)
                return 0
            build.compile_c(sources, target, program, include=include, what=what, shared=False)
            rows = [measure(scene, program, Path(folder)) for scene in watched(SCENES)]
        print_table(rows, COLUMNS)
        save_rows(options.json, "instructions", rows)
        dearer = [] if options.against is None else compared(rows, json.loads(options.against.read_text("utf-8")))
        for line in dearer:
            print(line)
        return bool(dearer)

    return run_command(work, (RuntimeError,))


def shares(scene: Scene, program: Path, folder: Path) -> list[dict[str, Any]]:
    """Functions in which more than 1 % of the instructions of a scene are, and the rest."""
    found = by_function(command_of(scene, program, folder), "ali3_run", folder)
    total = sum(found.values())
    most = {name: count / total for name, count in found.items() if count > LEAST * total}
    most["all others"] = 1.0 - sum(most.values())
    return [{"function": name, "share": share} for name, share in most.items()]


def compared(rows: Sequence[dict[str, Any]], table: dict[str, Any]) -> list[str]:
    """A sentence for each scene that takes over 3 % more than in a table; factorizations count without valgrind."""
    stored = {(row["scene"], row["step_ms"]): row for row in table["rows"]}
    lines = []
    for row in rows:
        before = stored.get((row["scene"], row["step_ms"]))
        if before is None:
            continue
        what = "instructions" if row["instructions"] and before["instructions"] else "factorizations"
        ratio = row[what] / before[what]
        if ratio > MOST:
            lines.append(f"{row['scene']}, {row['step_ms']:g} ms: {what} {100.0 * (ratio - 1.0):.1f} % more a step.")
    return lines


if __name__ == "__main__":
    sys.exit(main())
