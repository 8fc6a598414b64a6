"""Cars: ``python -m benchmarks.car PART``: accuracy and cost of manoeuvres, models and fidelities; measures of cars.

Errors of a manoeuvre are against a stored reference, which ``references`` writes. Path error: largest distance of the
car's reference point from its position in the reference at the same time, m, or divided by the path length. Error of
the wheel loads: largest error divided by the largest load of the manoeuvre. Times are the least processor time of the
kernel.
"""

import sys
import tempfile
from argparse import Namespace
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from ali3.errors import UserError
from benchmarks.car import (
    accuracy,
    all_cars,
    edge_answers,
    error_limits,
    fidelity,
    fidelity_runs,
    fmu_runs,
    manoeuvres,
    measures,
    road_faces,
    table_cars,
    trajectories,
)
from benchmarks.shared.command import Part, run, watched
from benchmarks.shared.pages import Row
from mbs.vehicle import car_names, load

REPEATS = {"repeats": (3, "timed runs of a row")}


def _accuracy(options: Namespace) -> list[dict[str, Any]]:
    runs = [(name, h) for name in options.only for h in accuracy.STEPS]
    with tempfile.TemporaryDirectory() as folder:
        fmu = None if options.no_fmu else fmu_runs.built_fmu(Path(folder))
        return [accuracy.measure(name, h, fmu, options.repeats) for name, h in watched(runs)]


def _tables(options: Namespace) -> list[dict[str, Any]]:
    runs = [(car, name) for car in options.cars for name in trajectories.referenced(car) if name in options.only]
    return [table_cars.compare(*run, table_cars.STEP, options.repeats) for run in watched(runs)]


def _handling(options: Namespace) -> list[dict[str, Any]]:
    # axles given by curves have no links
    names = options.cars or [name for name in car_names() if load(name).linked]
    return measures.measure_rows({name: measures.measure(load(name)) for name in watched(names)})


def _fidelity(options: Namespace) -> list[dict[str, Any]]:
    runs = [(name, f, h) for name in options.only for f in fidelity.COMPARED for h in fidelity.STEPS]
    return [fidelity.measure(*run, options.repeats) for run in watched(runs)]


def _references(options: Namespace) -> None:
    if options.car not in manoeuvres.CARS:
        raise UserError(f"There are no references of a car {options.car!r}; there are: {', '.join(manoeuvres.CARS)}.")
    print("\n".join([trajectories.write(name, options.car) for name in watched(options.only)]))


def _fidelity_references(options: Namespace) -> None:
    print("\n".join([fidelity_runs.write_reference(name) for name in watched(options.only)]))


def _tables_block(rows: Sequence[Row]) -> dict[str, str]:
    return {"tables": f"{table_cars.table_of(rows)}\n\n{table_cars.verdict(rows)}"}


PARTS = {
    "accuracy": Part(
        "errors and cost of the prototype's manoeuvres by step, in the kernel and through its FMU",
        _accuracy,
        names=manoeuvres.NAMES,
        options={"repeats": (5, "timed runs of a row"), "no_fmu": (False, "leave the runs through FMPy out")},
        pages=("speed.md", "fmu.md"),
        blocks=accuracy.car_blocks,
    ),
    "cars": Part(
        "one table of all cars with steps of 5 ms",
        lambda options: all_cars.measure(options.only, options.repeats),
        names=manoeuvres.CARS,
        options=REPEATS,
        pages=("cars.md",),
        blocks=lambda rows: {"all cars": all_cars.text_of(rows)},
    ),
    "tables": Part(
        "cars whose suspensions are tables against those with links",
        _tables,
        names=manoeuvres.NAMES,
        options=REPEATS | {"cars": (table_cars.CARS, f"of {', '.join(manoeuvres.CARS)}")},
        pages=("cars.md",),
        blocks=_tables_block,
    ),
    "handling": Part(
        "ride, roll, understeer and performance of cars beside what cars of the small class have",
        _handling,
        options={"cars": ([], "names, folders or files; by default all of the package that have links")},
        pages=("cars.md",),
        blocks=lambda rows: {"handling": measures.measure_table(rows)},
    ),
    "trust": Part(
        "errors by steps in a period and by speed over a kerb",
        lambda options: error_limits.measure(),
        pages=("trust.md",),
        blocks=error_limits.trust_blocks,
    ),
    "fidelity": Part(
        "how much model a car needs: manoeuvres with every fidelity of the prototype",
        _fidelity,
        names=fidelity_runs.NAMES,
        options=REPEATS,
        pages=("flexible_car.md",),
        blocks=fidelity.choice_blocks,
        chart=fidelity.chart,
    ),
    "faces": Part(
        "wheel loads up a kerb and up faces of grids, coasting in neutral",
        lambda options: [road_faces.measure(options.car, height) for height in watched(road_faces.HEIGHTS)],
        options={"car": ("hatchback", "name, folder or file")},
        pages=("roads.md",),
        blocks=lambda rows: {"faces": road_faces.face_table(rows)},
    ),
    "edges": Part(
        "wheel loads up edges that a partner at the road port answers",
        lambda options: [edge_answers.measure(car, edge) for car, edge in watched(edge_answers.EDGES)],
        pages=("ports.md",),
        blocks=lambda rows: {"edges": edge_answers.edge_table(rows)},
    ),
    "references": Part(
        "write reference trajectories of a car, in steps of 0.1 ms; each file has the differences of larger steps",
        _references,
        names=manoeuvres.NAMES,
        options={"car": (manoeuvres.PROTOTYPE, f"of {', '.join(manoeuvres.CARS)}")},
        rows=False,
    ),
    "fidelity-references": Part(
        "write the references of the fidelities, of the finest model in steps of 0.5 ms",
        _fidelity_references,
        names=fidelity_runs.NAMES,
        rows=False,
    ),
}

main = partial(run, "car", __doc__, PARTS)

if __name__ == "__main__":
    sys.exit(main())
