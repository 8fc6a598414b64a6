"""Cars whose suspensions are tables against those with links: errors, cost, and the table of `docs/cars.md`."""

import time
from collections.abc import Sequence
from functools import cache
from typing import Any

from benchmarks.car import accuracy, manoeuvres, trajectories
from benchmarks.shared.pages import Row, table
from mbs import System, compile
from mbs.vehicle import load
from mbs.vehicle.levels.errors import load_error, path_error

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
    """Row of a manoeuvre: errors, and times if `repeats` is not 0. `h`: step, s."""
    manoeuvre, (_, reference, length) = manoeuvres.load(name, car), trajectories.read(name, car)
    path_length, every = max(length, 1.0), round(manoeuvres.sampling(name, car) / h)
    systems = {"tables": tabled(name, car), "links": manoeuvres.system_of(name, car)}
    runs = {kind: manoeuvres.run_on(system, manoeuvre, h, every=every) for kind, system in systems.items()}
    row: dict[str, Any] = {"car": car, "manoeuvre": name, "h_s": h, "way_m": length}
    for kind, run in runs.items():
        assert run.report is not None
        spent = None
        if repeats:
            spent = manoeuvres.time_on(systems[kind], manoeuvre, h, repeats, time.process_time)
        row |= {
            f"{kind}_path": path_error(run, reference) / path_length,
            f"{kind}_load": load_error(run, reference),
            f"{kind}_iterations": run.report.mean_iterations,
            f"{kind}_us": None if spent is None else 1e6 * spent * h / manoeuvre.stop_time,
        }
    return row | {
        "apart_path": path_error(runs["tables"], runs["links"]) / path_length,
        "apart_load": load_error(runs["tables"], runs["links"]),
    }


def table_of(rows: Sequence[Row]) -> str:
    """Table of the page."""
    lines = [
        {
            "car": r["car"],
            "manoeuvre": r["manoeuvre"].replace("_", " "),
            "h, ms": 1e3 * r["h_s"],
            "tables: path, loads": _errors(r, "tables"),
            "links: path, loads": _errors(r, "links"),
            "apart: path, loads": _errors(r, "apart"),
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


def _errors(row: Row, prefix: str) -> str:
    return f"{row[f'{prefix}_path']:.1e}, {100.0 * row[f'{prefix}_load']:.2g} %"
