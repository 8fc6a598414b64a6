"""Cars whose suspensions are tables against those with links: errors, cost, and the table of `docs/cars.md`."""

from collections.abc import Sequence
from functools import cache
from typing import Any

from benchmarks.car import accuracy, manoeuvres, trajectories
from benchmarks.shared.pages import Row, table
from mbs import System, compile
from mbs.vehicle import load

STEP = 0.005  # s
CARS = (manoeuvres.PROTOTYPE, "hatchback")
SMOOTH = ("step_steer_given_throttle", "slalom", "steady_cornering", "double_lane_change_replay")
"""Manoeuvres of rolling wheels on a plane road, without sudden pedals."""


@cache
def tabled(name: str, car: str) -> System:
    """A car whose suspensions are tables, on the road of a manoeuvre."""
    road = manoeuvres.rise(car) if name in manoeuvres.OTHER_ROAD else None
    return compile(load(car).model(road, fidelity="table"))


def compare(car: str, name: str, h: float, repeats: int = 0) -> dict[str, Any]:
    """Row of a manoeuvre: errors of both models, and times if `repeats` is not 0. `h`: step, s."""
    manoeuvre, (_, reference, length) = manoeuvres.load(name, car), trajectories.read(name, car)
    path_length = max(length, 1.0)
    row: dict[str, Any] = {"car": car, "manoeuvre": name, "h_s": h, "way_m": length}
    runs = {}
    for kind, system in (("tables", tabled(name, car)), ("links", manoeuvres.system_of(name, car))):
        runs[kind] = accuracy.run_at_reference(name, h, car, system)
        row |= _errors(kind, runs[kind], reference, path_length)
        cost = accuracy.cost(system, manoeuvre, runs[kind], h, repeats)
        row |= {f"{kind}_iterations": cost["iterations_mean"], f"{kind}_us": cost["us_per_step"]}
    return row | _errors("apart", runs["tables"], runs["links"], path_length)


def _errors(kind: str, run: Any, reference: Any, length: float) -> dict[str, float]:
    path, load = accuracy.errors_of(run, reference, length).values()
    return {f"{kind}_path": path, f"{kind}_load": load}


def table_of(rows: Sequence[Row]) -> str:
    """Table of the page."""
    lines = [
        {
            "car": r["car"],
            "manoeuvre": r["manoeuvre"].replace("_", " "),
            "h, ms": 1e3 * r["h_s"],
            "tables: path, loads": _error_text(r, "tables"),
            "links: path, loads": _error_text(r, "links"),
            "apart: path, loads": _error_text(r, "apart"),
            "iterations, tables, links": f"{r['tables_iterations']:.2f}, {r['links_iterations']:.2f}",
            "us a step, tables, links": f"{r['tables_us']:.0f}, {r['links_us']:.0f}" if r["tables_us"] else None,
        }
        for r in rows
    ]
    return table(lines, dict.fromkeys(lines[0], "") | {"h, ms": "g"})


def verdict(rows: Sequence[Row]) -> str:
    """Sentence on the cars and manoeuvres with errors of tables above 1 % of the path or 3 % of the loads."""
    outside = [
        f"{r['car']}, {r['manoeuvre'].replace('_', ' ')}"
        for r in rows
        if r["tables_path"] > accuracy.PATH_BOUND or r["tables_load"] > accuracy.LOAD_BOUND
    ]
    smooth = [r for r in rows if r["manoeuvre"] in SMOOTH]
    sentence = f"Tables are outside of 1 % of the path and 3 % of the loads in: {'; '.join(outside) or 'none'}."
    if smooth:
        path, loads = (max(r[f"tables_{key}"] for r in smooth) for key in ("path", "load"))
        sentence += f" In smooth manoeuvres they are within {path:.1e} and {100.0 * loads:.2g} %."
    return sentence


def _error_text(row: Row, kind: str) -> str | None:
    return accuracy.error_text(row[f"{kind}_path"], row[f"{kind}_load"])
