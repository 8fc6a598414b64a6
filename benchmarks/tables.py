"""Cars whose suspensions are tables against those with links: ``python -m benchmarks.tables [--write] [--json FILE]``.

Of each manoeuvre with references (`benchmarks.car_references`): errors of the car by tables and of the one with links
against the car with links and steps of 0.1 ms; how far both are apart with the same step; what a step takes, processor
time. Path: largest distance of the reference points over the length of the way; loads: largest error of a wheel load
over the largest load. ``--write`` puts the table into `docs/cars.md`.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from ali3.files import write_text
from ali3.running import run_command
from benchmarks.car import manoeuvres, tabled_cars, trajectories
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.pages import DOCS, replace

PAGE = DOCS / "cars.md"


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, print, and write what was asked for."""
    parser = parser_of("tables", __doc__)
    parser.add_argument("--cars", nargs="+", default=tabled_cars.CARS, choices=manoeuvres.CARS, metavar="CAR")
    parser.add_argument("--manoeuvres", nargs="+", choices=manoeuvres.NAMES, metavar="NAME")
    steps = [tabled_cars.STEP]
    parser.add_argument("--steps", nargs="+", type=float, default=steps, metavar="H", help="s; default: 0.005")
    parser.add_argument("--repeats", type=int, default=3, metavar="N", help="timed runs per row; default: 3")
    parser.add_argument("--write", action="store_true", help="put the table into docs/cars.md")
    options = parser.parse_args(arguments)

    def work() -> int:
        names = {car: options.manoeuvres or trajectories.referenced(car) for car in options.cars}
        todo = [(car, name, h) for car in options.cars for name in names[car] for h in options.steps]
        rows = [tabled_cars.compare(*one, repeats=options.repeats) for one in watched(todo)]
        text = tabled_cars.table_of(rows)
        text += f"\n\n{tabled_cars.verdict(rows)}"
        print(text)
        save_rows(options.json, "tables", rows, repeats=options.repeats)
        if options.write:
            write_text(PAGE, replace(PAGE.read_text(encoding="utf-8"), {"tables": text}))
        return 0

    return run_command(work, (RuntimeError,))


if __name__ == "__main__":
    sys.exit(main())
