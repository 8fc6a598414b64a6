"""Random mechanisms and cars with their true errors: whether runs tell when they are wrong, and only then."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

import mbs
from benchmarks.methods import random_cars, random_machines, random_mechanisms
from benchmarks.references import masses_on_a_line, newton_euler
from benchmarks.shared.pages import Row, table
from mbs.results.accuracy import WRONG_ERROR, extent, judged_sensors
from mbs.simulation.prepared_system import length_of

Array = NDArray[np.float64]
STEPS = (0.001, 0.002, 0.005, 0.01, 0.02)  # s
TOLERANCES = (1e-2, 1e-3, 1e-4)
CAR_SHARE = 0.1  # cars beside so many mechanisms
NOTHING = 1e-3  # of the range or the length: of a smaller error no estimate is asked
FACTOR = 10.0  # by which an estimate may be off
BEYOND = 10.0  # tolerances: wrong
KINDS = ("planar", "spatial", "car", *random_machines.KINDS)
VERDICTS = ("right", "false alarm", "refused", "wrong, told", "silently wrong")
TOLD = ("false alarm", "refused", "silently wrong")
"""Verdicts that are shown case by case."""
COLUMNS = {
    "number": "d",
    "kind": "",
    "asked": "",
    "error": ".1e",
    "told": ".1e",
    "verdict": "",
    "cpu_s": ".2g",
}
SUMMARY = {
    "asked": "",
    "runs": "d",
    "right": "d",
    "false alarms": "d",
    "refused": "d",
    "wrong, told": "d",
    "silently wrong": "d",
    "estimates": "d",
    "within ten times": ".0%",
    "steps over its own": ".2f",
    "cost, median": ".3g",
}


def rows_of(seed: int, numbers: Iterable[int], family: str = "mechanisms") -> Iterator[dict[str, Any]]:
    """Rows of the cases of a seed; a case without a reference gives one row that says so.

    `family`: ``mechanisms``, with cars among them, or ``machines``.
    """
    empty = {"seed": seed} | dict.fromkeys(COLUMNS)
    for number in numbers:
        rng = np.random.default_rng([seed, number])
        make = _machine
        if family == "mechanisms":
            make = _car if rng.random() < CAR_SHARE / (1.0 + CAR_SHARE) else _mechanism
        yield from (empty | row for row in make(number, rng))


def _mechanism(number: int, rng: np.random.Generator) -> Iterator[dict[str, Any]]:
    name, drawing = random_mechanisms.drawing(rng)
    case = {"number": number, "kind": name, "class": KINDS[drawing.dimension - 2]}
    names = [f"tip{i}.{c}" for i in range(len(drawing.links)) for c in "xyz"[: drawing.dimension]]

    def truth() -> dict[str, Array]:
        found = newton_euler.motion(drawing)
        return dict(zip(names, found.reshape(len(found), -1).T, strict=True))

    yield from _both(case, rng, drawing.span, truth, lambda: random_mechanisms.model_of(drawing))


def _machine(number: int, rng: np.random.Generator) -> Iterator[dict[str, Any]]:
    kind, machine = random_machines.machine(rng)
    case = {"number": number, "kind": kind, "class": kind}

    def truth() -> dict[str, Array]:
        found = masses_on_a_line.motion(machine)
        return {f"x{i}": found[:, i] for i in range(len(machine.masses)) if i not in machine.driven}

    yield from _both(case, rng, machine.span, truth, lambda: random_machines.model_of(machine))


def _both(
    case: dict[str, Any],
    rng: np.random.Generator,
    span: float,
    make_truth: Callable[[], dict[str, Array]],
    make_model: Callable[[], mbs.Model],
) -> Iterator[dict[str, Any]]:
    """In equal steps and under a tolerance."""
    h, tolerance = float(rng.choice(STEPS)), float(rng.choice(TOLERANCES))
    try:
        truth = make_truth()
    except newton_euler.NoReferenceError as none:
        yield case | {"asked": "reference", "verdict": "none", "reason": str(none)}
        return
    system = mbs.compile(make_model())
    system.to_bytes()  # assembly modes are searched on demand: at the model's cost, not at the first run's
    t = np.linspace(0.0, span, newton_euler.INSTANTS + 1)
    steps = max(1, round(span / newton_euler.INSTANTS / h))
    fixed = span / newton_euler.INSTANTS / steps  # the nearest step that ends at the instants
    units, length = {"m": list(truth)}, length_of(system)
    yield case | _judged(
        f"{h:g} s",
        lambda: mbs.simulate(system, span, fixed, every=steps, progress=False),
        lambda run: (_of_range(run, truth, units, length), run.accuracy.error if run.accuracy else None, WRONG_ERROR),
    )
    yield case | _judged(
        f"tolerance {tolerance:g}",
        lambda: mbs.simulate(system, span, times=t, tolerance=tolerance, progress=False),
        lambda run: (_of_length(run, truth), run.control.error if run.control else None, BEYOND * tolerance),
    )


def _car(number: int, rng: np.random.Generator) -> Iterator[dict[str, Any]]:
    drive = random_cars.drive(rng)
    tolerance = float(rng.choice(TOLERANCES[:2]))
    case = {"number": number, "kind": f"{drive.car} {drive.step:g} m, {drive.speed:.1f} m/s", "class": "car"}
    try:
        truth = drive.truth()
    except random_cars.NoReferenceError as none:
        yield case | {"asked": "reference", "verdict": "none", "reason": str(none)}
        return
    units, length = judged_sensors(drive.system), length_of(drive.system)
    for h in random_cars.STEPS:
        yield case | _judged(
            f"{h:g} s",
            lambda h=h: drive.run(h=h),  # type: ignore[misc]
            lambda run: (
                _of_range(run, truth, units, length),
                run.accuracy.error if run.accuracy else None,
                WRONG_ERROR,
            ),
        )
    t = np.linspace(0.0, drive.span, len(next(iter(truth.values()))))
    yield case | _judged(
        f"tolerance {tolerance:g}",
        lambda: drive.run("auto", times=t, tolerance=tolerance),
        lambda run: (_of_length(run, {n: truth[n] for n in units["m"]}), run.control.error, BEYOND * tolerance),
    )


def _judged(
    asked: str,
    make: Callable[[], mbs.Trajectory],
    judge: Callable[[mbs.Trajectory], tuple[float, float | None, float]],
) -> dict[str, Any]:
    """A run with its verdict."""
    row: dict[str, Any] = {"asked": asked, "verdict": "refused", "error": None, "told": None, "warnings": []}
    begin = time.process_time()
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            run = make()
    except mbs.SimulationError as refused:
        return row | {"cpu_s": time.process_time() - begin, "reason": str(refused)}
    row["cpu_s"] = time.process_time() - begin
    error, told, most = judge(run)
    wrong, said = not error <= most, [f"{w.category.__name__}: {w.message}" for w in caught]
    verdict = VERDICTS[(3 if said else 4) if wrong else (1 if said else 0)]
    method = run.control.method if run.control is not None else ""
    steps = None if run.accuracy is None else 1.0 + run.accuracy.repeat_cost
    return row | {"verdict": verdict, "error": error, "told": told, "warnings": said, "method": method, "steps": steps}


def _of_range(
    run: mbs.Trajectory, truth: Mapping[str, Array], units: Mapping[str, Sequence[str]], length: float
) -> float:
    """Largest error over the largest range in a unit, as runs of a model with this length, m, judge themselves."""
    worst = 0.0
    for unit, names in units.items():
        size = extent(unit, [truth[n] for n in names], length)
        if size > 0.0:
            worst = max(worst, *(float(np.abs(run[n] - truth[n]).max()) / size for n in names))
    return worst


def _of_length(run: mbs.Trajectory, truth: Mapping[str, Array]) -> float:
    """Largest error over the length of the model."""
    assert run.control is not None
    return max(float(np.abs(run[n] - values).max()) for n, values in truth.items()) / run.control.length


def summary(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """Counts per class of cases, of fixed steps and under a tolerance."""
    lines = []
    for kind in KINDS:
        for asked, controlled in (("fixed steps", False), ("tolerance", True)):
            mine = [r for r in rows if r["class"] == kind and r["cpu_s"] is not None]
            part = [r for r in mine if ("tol" in r["asked"]) == controlled]
            if not part:
                continue
            count = {v: sum(r["verdict"] == v for r in part) for v in VERDICTS}
            told = [r for r in part if r.get("told") is not None and r["error"] > _least(r)]
            near = sum(1.0 / FACTOR <= r["told"] / r["error"] <= FACTOR for r in told)
            steps = [r["steps"] for r in part if r["verdict"] == VERDICTS[0] and r["steps"] is not None]
            lines.append(
                {
                    "asked": f"{kind}, {asked}",
                    "runs": len(part),
                    "right": count["right"] + count["false alarm"],
                    "false alarms": count["false alarm"],
                    "refused": count["refused"],
                    "wrong, told": count["wrong, told"],
                    "silently wrong": count["silently wrong"],
                    "estimates": len(told),
                    "within ten times": near / len(told) if told else None,
                    "steps over its own": float(np.median(steps)) if steps else None,
                    "cost, median": float(np.median([r["cpu_s"] for r in part])),
                }
            )
    return lines


def _least(row: Row) -> float:
    """The smallest error of which an estimate is asked: what nobody asked for better than a hundredth of."""
    return 0.01 * float(row["asked"].split()[1]) if "tol" in row["asked"] else NOTHING


def random_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Verdicts on random machines of several seeds."""
    columns = {k: f for k, f in SUMMARY.items() if not k.startswith("cost")}
    seeds = ", ".join(map(str, dict.fromkeys(r["seed"] for r in rows)))
    none = sum(r["verdict"] == "none" for r in rows)
    said = f"Seeds {seeds}, {len({(r['seed'], r['number']) for r in rows})} machines; {none} without a reference."
    return {"honesty machines": f"{said}\n\n{table(summary(rows), columns)}"}
