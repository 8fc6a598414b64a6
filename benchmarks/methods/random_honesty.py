"""Random cases with their true errors: whether wrong runs warn, and only those."""

import time
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

import mbs
from benchmarks.methods.families import FAMILIES, Case, CaseRun
from benchmarks.methods.true_error import true_error
from benchmarks.references.newton_euler import NoReferenceError
from benchmarks.shared.pages import Row, table
from mbs.kernel.header.limits import WRONG_ERROR
from mbs.results.comparison import compared_sensors
from mbs.simulation.prepared_system import length_of

Array = NDArray[np.float64]
NEGLIGIBLE = 1e-3  # error relative to the range or the length below which estimates are not compared
MAX_RATIO = 10.0  # largest ratio between an error and its estimate
WRONG_TOLERANCES = 10.0  # tolerances from which an error is wrong
UNDECIDED = (0.9, 1.1)  # range of the error relative to the limit in which runs are not judged
VERDICTS = ("right", "false alarm", "refused", "wrong, warned", "silently wrong", "near")
ERRORS = (mbs.AccuracyWarning, mbs.BranchWarning)
"""Warnings of errors; others are about models, such as bending beyond the range of the modes."""
LISTED = ("false alarm", "refused", "silently wrong")
"""Verdicts whose cases are listed."""
COLUMNS = {
    "family": "",
    "number": "d",
    "kind": "",
    "asked": "",
    "error": ".1e",
    "estimate": ".1e",
    "verdict": "",
    "cpu_s": ".2g",
}
COUNTS = {
    "runs": "d",
    "right": "d",
    "false alarms": "d",
    "refused": "d",
    "wrong, warned": "d",
    "silently wrong": "d",
    "near the limit": "d",
    "estimates": "d",
    "within ten times": ".0%",
    "steps over its own": ".2f",
}
SUMMARY = {"family": "", "seed": "d", **COUNTS, "no reference": "d"}


def rows_of(family: str, seed: int, numbers: Iterable[int]) -> Iterator[dict[str, Any]]:
    """Rows of cases of a seed, with fixed steps and with a tolerance; one row for a case without reference.

    A case depends on its seed and number only.
    """
    for number in numbers:
        row = {"seed": seed} | dict.fromkeys(COLUMNS) | {"family": family, "number": number}
        rng = np.random.default_rng([seed, number])
        try:
            case = FAMILIES[family](rng)
        except NoReferenceError as no_reference:
            yield row | {"asked": "reference", "verdict": "none", "reason": str(no_reference)}
            continue
        yield from (row | {"kind": case.kind} | result for result in judge(case, rng))


def judge(case: Case, rng: np.random.Generator) -> Iterator[dict[str, Any]]:
    """Results of a case with fixed steps and, if possible, with a tolerance, each chosen at random."""
    case.system.to_bytes()  # assembly modes are searched here, so that their time is not part of the first run
    intervals = len(next(iter(case.reference.values()))) - 1
    h = float(rng.choice(case.steps))
    every = max(1, round(case.span / intervals / h))
    fixed_step = case.span / intervals / every  # the nearest step that reaches the instants
    sensors = compared_sensors(case.system)

    def of_range(values: Mapping[str, Array]) -> float:
        return true_error(case.system, case.reference, values)

    def of_length(values: Mapping[str, Array]) -> float:
        places = [np.abs(values[n] - true).max() for n, true in case.reference.items() if sensors[n].unit == "m"]
        return float(max(places)) / length_of(case.system)

    yield judged_run(f"{h:g} s", lambda: case.run(h=fixed_step, every=every), of_range, WRONG_ERROR)
    if case.tolerances:
        tolerance, t = float(rng.choice(case.tolerances)), np.linspace(0.0, case.span, intervals + 1)
        yield judged_run(
            f"tolerance {tolerance:g}",
            lambda: case.run(tolerance=tolerance, times=t),
            of_length,
            WRONG_TOLERANCES * tolerance,
        )


def judged_run(
    asked: str, run: Callable[[], CaseRun], error_of: Callable[[Mapping[str, Array]], float], limit: float
) -> dict[str, Any]:
    """Row of a run: verdict, error, estimate and warnings; `error_of`: error of its values, wrong above `limit`."""
    row: dict[str, Any] = {"asked": asked, "verdict": "refused", "error": None, "estimate": None, "warnings": []}
    begin = time.process_time()
    try:
        with warnings.catch_warnings(record=True) as caught_warnings:
            warnings.simplefilter("always")
            result = run()
    except mbs.SimulationError as simulation_error:
        return row | {"cpu_s": time.process_time() - begin, "reason": str(simulation_error)}
    row["cpu_s"] = time.process_time() - begin
    error = error_of(result.values)
    messages = [f"{w.category.__name__}: {w.message}" for w in caught_warnings if w.category in ERRORS]
    return row | {
        "verdict": verdict_of(error, limit, bool(messages)),
        "error": error,
        "estimate": result.estimate,
        "warnings": messages,
        "method": result.method,
        "steps": result.cost,
    }


def verdict_of(error: float, limit: float, warned: bool) -> str:
    """One of `VERDICTS` for a run with or without a warning, which is wrong if its error exceeds `limit`."""
    if limit == WRONG_ERROR and UNDECIDED[0] * limit <= error <= UNDECIDED[1] * limit:
        return "near"
    if error <= limit:
        return "false alarm" if warned else "right"
    return "wrong, warned" if warned else "silently wrong"


def counts(rows: Sequence[Row]) -> dict[str, Any]:
    """Values of the columns `COUNTS` for rows of runs."""
    count = {v: sum(r["verdict"] == v for r in rows) for v in VERDICTS}
    estimated = [r for r in rows if r.get("estimate") is not None and r["error"] > _negligible(r)]
    close = sum(1.0 / MAX_RATIO <= r["estimate"] / r["error"] <= MAX_RATIO for r in estimated)
    steps = [r["steps"] for r in rows if r["verdict"] == VERDICTS[0] and r["steps"] is not None]
    return {
        "runs": len(rows),
        "right": count["right"] + count["false alarm"],
        "false alarms": count["false alarm"],
        "refused": count["refused"],
        "wrong, warned": count["wrong, warned"],
        "silently wrong": count["silently wrong"],
        "near the limit": count["near"],
        "estimates": len(estimated),
        "within ten times": close / len(estimated) if estimated else None,
        "steps over its own": float(np.median(steps)) if steps else None,
    }


def summary(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """Counts by family and seed, with fixed steps and with a tolerance."""
    lines = []
    for family, seed in dict.fromkeys((r["family"], r["seed"]) for r in rows):
        seed_rows = [r for r in rows if (r["family"], r["seed"]) == (family, seed)]
        no_reference = sum(r["verdict"] == "none" for r in seed_rows)
        for requested, controlled in (("fixed steps", False), ("tolerance", True)):
            runs = [r for r in seed_rows if r["verdict"] != "none" and ("tol" in r["asked"]) == controlled]
            if not runs:
                continue
            lines.append(
                {"family": f"{family}, {requested}", "seed": seed, **counts(runs), "no reference": no_reference}
            )
    return lines


def _negligible(row: Row) -> float:
    """Smallest error whose estimate is compared: a hundredth of the tolerance, or `NEGLIGIBLE`."""
    requested = row.get("asked", "")
    return 0.01 * float(requested.split()[1]) if "tol" in requested else NEGLIGIBLE


def text_of(rows: Sequence[Row]) -> str:
    """Tables of the listed cases and of the counts by family."""
    listed_rows = [row for row in rows if row["verdict"] in LISTED]
    cases = table(listed_rows, COLUMNS) if listed_rows else "none against the rule"
    return f"{cases}\n\n{table(summary(rows), SUMMARY)}"


def random_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Table of the counts of all families."""
    count = max(r["number"] for r in rows) + 1
    return {"honesty random": f"Up to {count} cases of a family and seed.\n\n{table(summary(rows), SUMMARY)}"}
