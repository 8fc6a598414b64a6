"""One table of all cars against their references.

For each car, over the manoeuvres that have references, with steps of 5 ms: the largest path error divided by the path
length and the largest wheel-load error divided by the largest load, each with its manoeuvre; simulated time divided by
processor time of the slowest manoeuvre; instructions of a step of the slalom, if valgrind is installed.
"""

import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks.car import accuracy, manoeuvres, trajectories
from benchmarks.car.scene_instructions import measure as count
from benchmarks.car.step_scenes import Scene, compile_program
from benchmarks.shared.command import watched
from benchmarks.shared.pages import Row, table

STEP = 0.005  # s
COUNTED = 500  # steps whose instructions are counted


def measure(cars: Sequence[str], repeats: int) -> list[dict[str, Any]]:
    """A row for each car."""
    with tempfile.TemporaryDirectory() as folder:
        program = compile_program(Path(folder))
        return [row_of(car, repeats, program, Path(folder)) for car in watched(cars)]


def row_of(car: str, repeats: int, program: Path, folder: Path) -> dict[str, Any]:
    """Row of a car: its errors against its references, and its cost."""
    rows = [accuracy.measure(name, STEP, None, repeats, car) for name in trajectories.referenced(car)]
    path, load = (max(rows, key=lambda row: row[key]) for key in accuracy.ERRORS)
    slowest = min(rows, key=lambda row: row["realtime_factor"])
    scene = Scene(car, STEP, COUNTED, lambda: manoeuvres.system_of("slalom", car), "slalom")
    return {
        "car": car,
        "manoeuvres": len(rows),
        "path": {key: path[key] for key in ("manoeuvre", "path_error_rel")},
        "load": {key: load[key] for key in ("manoeuvre", "wheel_load_error_rel")},
        "realtime": {key: slowest[key] for key in ("manoeuvre", "realtime_factor")},
        "instructions": count(scene, program, folder)["instructions"],
    }


def text_of(rows: Sequence[Row]) -> str:
    """Table of the page."""
    lines = [
        {
            "car": f"`{r['car']}`",
            "largest path error": f"{r['path']['path_error_rel']:.1e} ({_title(r['path']['manoeuvre'])})",
            "largest wheel-load error": f"{100.0 * r['load']['wheel_load_error_rel']:.2g} % "
            f"({_title(r['load']['manoeuvre'])})",
            "times real time": f"{r['realtime']['realtime_factor']:.0f} ({_title(r['realtime']['manoeuvre'])})",
            "instructions a step": r["instructions"],
        }
        for r in rows
    ]
    return table(lines, dict.fromkeys(lines[0], "") | {"instructions a step": ",d"})


def _title(name: str) -> str:
    return name.replace("_", " ")
