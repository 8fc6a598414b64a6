"""Random cases of the families with their true errors: whether runs warn when they are wrong, and only then."""

import time
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

import mbs
from benchmarks.methods.families import FAMILIES, Case, CaseRun
from benchmarks.references.newton_euler import NoReferenceError
from benchmarks.shared.pages import Row, table
from mbs.kernel.header.limits import WRONG_ERROR
from mbs.results.comparison import compared_sensors, sizes_of
from mbs.simulation.prepared_system import length_of

Array = NDArray[np.float64]
NOTHING = 1e-3  # of the range or the length: of a smaller error no estimate is asked
FACTOR = 10.0  # by which an estimate may be off
BEYOND = 10.0  # tolerances: wrong
NEAR = (0.9, 1.1)  # times what is wrong: between them a run counts neither way
VERDICTS = ("right", "false alarm", "refused", "wrong, told", "silently wrong", "near")
ERRORS = (mbs.AccuracyWarning, mbs.BranchWarning)
"""Warnings of an error; others concern models, such as one that bends too much for its modes."""
TOLD = ("false alarm", "refused", "silently wrong")
"""Verdicts that are shown case by case."""
COLUMNS = {
    "family": "",
    "number": "d",
    "kind": "",
    "asked": "",
    "error": ".1e",
    "told": ".1e",
    "verdict": "",
    "cpu_s": ".2g",
}
SUMMARY = {
    "family": "",
    "seed": "d",
    "runs": "d",
    "right": "d",
    "false alarms": "d",
    "refused": "d",
    "wrong, told": "d",
    "silently wrong": "d",
    "near the limit": "d",
    "estimates": "d",
    "within ten times": ".0%",
    "steps over its own": ".2f",
    "no reference": "d",
}


def rows_of(family: str, seed: int, numbers: Iterable[int]) -> Iterator[dict[str, Any]]:
    """Rows of the cases of a seed, in equal steps and under a tolerance; one that says so of a case without reference.

    A case depends on its seed and number alone.
    """
    for number in numbers:
        row = {"seed": seed} | dict.fromkeys(COLUMNS) | {"family": family, "number": number}
        rng = np.random.default_rng([seed, number])
        try:
            case = FAMILIES[family](rng)
        except NoReferenceError as none:
            yield row | {"asked": "reference", "verdict": "none", "reason": str(none)}
            continue
        yield from (row | {"kind": case.kind} | found for found in judged(case, rng))


def judged(case: Case, rng: np.random.Generator) -> Iterator[dict[str, Any]]:
    """In equal steps and, if it can be asked for, under a tolerance, each drawn by chance."""
    case.system.to_bytes()  # assembly modes are searched on demand: at the model's cost, not at the first run's
    intervals = len(next(iter(case.truth.values()))) - 1
    h = float(rng.choice(case.steps))
    every = max(1, round(case.span / intervals / h))
    fixed = case.span / intervals / every  # the nearest step that ends at the instants
    sensors = {name: sensor for name, sensor in compared_sensors(case.system).items() if name in case.truth}
    size = sizes_of(case.truth, sensors, length_of(case.system))

    def of_range(values: Mapping[str, Array]) -> float:
        return max((sensors[n].gap(values[n], case.truth[n]) / s for n, s in size.items()), default=0.0)

    def of_length(values: Mapping[str, Array]) -> float:
        places = [np.abs(values[n] - true).max() for n, true in case.truth.items() if sensors[n].unit == "m"]
        return float(max(places)) / length_of(case.system)

    yield _verdict(f"{h:g} s", lambda: case.run(h=fixed, every=every), of_range, WRONG_ERROR)
    if case.tolerances:
        tolerance, t = float(rng.choice(case.tolerances)), np.linspace(0.0, case.span, intervals + 1)
        yield _verdict(
            f"tolerance {tolerance:g}", lambda: case.run(tolerance=tolerance, times=t), of_length, BEYOND * tolerance
        )


def _verdict(
    asked: str, run: Callable[[], CaseRun], error_of: Callable[[Mapping[str, Array]], float], most: float
) -> dict[str, Any]:
    row: dict[str, Any] = {"asked": asked, "verdict": "refused", "error": None, "told": None, "warnings": []}
    begin = time.process_time()
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            result = run()
    except mbs.SimulationError as refused:
        return row | {"cpu_s": time.process_time() - begin, "reason": str(refused)}
    row["cpu_s"] = time.process_time() - begin
    error = error_of(result.values)
    wrong, messages = not error <= most, [f"{w.category.__name__}: {w.message}" for w in caught if w.category in ERRORS]
    verdict = VERDICTS[(3 if messages else 4) if wrong else (1 if messages else 0)]
    if most == WRONG_ERROR and NEAR[0] * most <= error <= NEAR[1] * most:
        verdict = "near"
    return row | {
        "verdict": verdict,
        "error": error,
        "told": result.reported_error,
        "warnings": messages,
        "method": result.method,
        "steps": result.cost,
    }


def summary(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """Counts per family and seed, of fixed steps and under a tolerance."""
    lines = []
    for family, seed in dict.fromkeys((r["family"], r["seed"]) for r in rows):
        mine = [r for r in rows if (r["family"], r["seed"]) == (family, seed)]
        none = sum(r["verdict"] == "none" for r in mine)
        for requested, controlled in (("fixed steps", False), ("tolerance", True)):
            part = [r for r in mine if r["verdict"] != "none" and ("tol" in r["asked"]) == controlled]
            if not part:
                continue
            count = {v: sum(r["verdict"] == v for r in part) for v in VERDICTS}
            reported = [r for r in part if r.get("told") is not None and r["error"] > _least(r)]
            near = sum(1.0 / FACTOR <= r["told"] / r["error"] <= FACTOR for r in reported)
            steps = [r["steps"] for r in part if r["verdict"] == VERDICTS[0] and r["steps"] is not None]
            lines.append(
                {
                    "family": f"{family}, {requested}",
                    "seed": seed,
                    "runs": len(part),
                    "right": count["right"] + count["false alarm"],
                    "false alarms": count["false alarm"],
                    "refused": count["refused"],
                    "wrong, told": count["wrong, told"],
                    "silently wrong": count["silently wrong"],
                    "near the limit": count["near"],
                    "estimates": len(reported),
                    "within ten times": near / len(reported) if reported else None,
                    "steps over its own": float(np.median(steps)) if steps else None,
                    "no reference": none,
                }
            )
    return lines


def _least(row: Row) -> float:
    """The smallest error of which an estimate is asked: what nobody asked for better than a hundredth of."""
    return 0.01 * float(row["asked"].split()[1]) if "tol" in row["asked"] else NOTHING


def text_of(rows: Sequence[Row]) -> str:
    """Cases against the rule, and counts per family."""
    shown = [row for row in rows if row["verdict"] in TOLD]
    cases = table(shown, COLUMNS) if shown else "none against the rule"
    return f"{cases}\n\n{table(summary(rows), SUMMARY)}"


def random_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Verdicts on the cases of all families."""
    most = max(r["number"] for r in rows) + 1
    return {"honesty random": f"Up to {most} cases of a family and seed.\n\n{table(summary(rows), SUMMARY)}"}
