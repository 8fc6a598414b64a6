"""One table of all cars against their references: ``python -m benchmarks.car_table [--write] [--json FILE]``.

Of each car, over the manoeuvres that it has references of (`benchmarks.car_references`), with steps of 5 ms: the
largest error of the path over its length and of a wheel load over the largest one, each with its manoeuvre; that of the
load against loads up to half a step before and after, of a run of 0.2 ms; the manoeuvres outside of 1 % and 3 %, and
the step that keeps them inside; times real time of the slowest manoeuvre, by
processor time; instructions of a step of the slalom, where valgrind is installed. ``--write`` puts the rows of these
cars into `benchmarks/data/car_table.json`, and the table of all cars in that file into `docs/cars.md`.
"""

from __future__ import annotations

import json
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ali3.files import write_text
from ali3.running import run_command
from benchmarks.car import accuracy, manoeuvres, trajectories
from benchmarks.car.scene_instructions import SOURCE, Scene
from benchmarks.car.scene_instructions import measure as count
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.pages import DOCS, Row, replace, table
from mbs.kernel import build

STEP, SMALLER, FINE = 0.005, (0.002, 0.001), 0.0002  # s
COUNTED = 500  # steps
PAGE, STORED = DOCS / "cars.md", Path(__file__).parent / "data" / "car_table.json"


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, print, and write what was asked for."""
    parser = parser_of("car_table", __doc__)
    parser.add_argument("--write", action="store_true", help="put the table into docs/cars.md")
    parser.add_argument("--repeats", type=int, default=3, metavar="N", help="timed runs per manoeuvre; default: 3")
    parser.add_argument("--cars", nargs="+", default=manoeuvres.CARS, choices=manoeuvres.CARS, metavar="CAR")
    options = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "run_system"
        include, sources = (build.HERE / "include",), [SOURCE, *build.sources(lanes=False)]
        what = "the program that repeats steps"
        build.compile_c(sources, build.host_target(), program, include=include, what=what, shared=False)
        rows = [row_of(car, options.repeats, program, Path(folder)) for car in watched(options.cars)]
    if options.write:
        rows = with_stored(rows)
        save_rows(STORED, "car_table", rows, repeats=options.repeats)
    text = text_of(rows)
    print(text)
    save_rows(options.json, "car_table", rows, repeats=options.repeats)
    if options.write:
        write_text(PAGE, replace(PAGE.read_text(encoding="utf-8"), {"all cars": text}))
    return 0


def with_stored(rows: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """These rows and those stored of other cars, in the order of the cars."""
    stored = json.loads(STORED.read_text("utf-8"))["rows"] if STORED.is_file() else []
    found = {row["car"]: row for row in (*stored, *rows)}
    return [found[car] for car in manoeuvres.CARS if car in found]


def inside(row: Row) -> bool:
    """Whether both errors are within their bounds."""
    return bool(row["path_error_rel"] <= accuracy.PATH_BOUND and row["wheel_load_error_rel"] <= accuracy.LOAD_BOUND)


def row_of(car: str, repeats: int, program: Path, folder: Path) -> dict[str, Any]:
    """What is known of a car."""
    rows = [accuracy.measure(name, STEP, None, repeats, car) for name in trajectories.referenced(car)]
    path, load = (max(rows, key=lambda row: row[key]) for key in accuracy.ERRORS)
    needs: dict[str, float | None] = {}
    for row in rows:
        if not inside(row):
            finer = (accuracy.measure(row["manoeuvre"], h, None, 1, car) for h in SMALLER)
            needs[row["manoeuvre"]] = next((r["h_s"] for r in finer if inside(r)), None)
    worst = load["manoeuvre"]
    found, fine = (manoeuvres.run(worst, h, car=car) for h in (STEP, FINE))
    slowest = min(rows, key=lambda row: row["realtime_factor"])
    scene = Scene(car, STEP, COUNTED, lambda: manoeuvres.system_of("slalom", car), "slalom")
    return {
        "car": car,
        "manoeuvres": len(rows),
        "path": {key: path[key] for key in ("manoeuvre", "path_error_rel")},
        "load": {key: load[key] for key in ("manoeuvre", "wheel_load_error_rel")},
        "load_in_time": trajectories.load_error_in_time(found, fine, 0.5 * STEP),
        "needs": needs,
        "realtime": {key: slowest[key] for key in ("manoeuvre", "realtime_factor")},
        "instructions": count(scene, program, folder)["instructions"],
    }


def text_of(rows: Sequence[Row]) -> str:
    """The table of the page."""
    lines = [
        {
            "car": f"`{r['car']}`",
            "largest path error": f"{r['path']['path_error_rel']:.1e} ({_words(r['path']['manoeuvre'])})",
            "largest wheel-load error": f"{100.0 * r['load']['wheel_load_error_rel']:.2g} % "
            f"({_words(r['load']['manoeuvre'])})",
            "within half a step in time": f"{100.0 * r['load_in_time']:.2g} %",
            "outside of 1 %, 3 %; inside with": "; ".join(
                f"{_words(name)}; {'–' if h is None else f'{1e3 * h:g} ms'}" for name, h in r["needs"].items()
            )
            or "none",
            "times real time": f"{r['realtime']['realtime_factor']:.0f} ({_words(r['realtime']['manoeuvre'])})",
            "instructions a step": r["instructions"],
        }
        for r in rows
    ]
    return table(lines, dict.fromkeys(lines[0], "") | {"instructions a step": ",d"})


def _words(name: str) -> str:
    return name.replace("_", " ")


if __name__ == "__main__":
    sys.exit(run_command(main))
