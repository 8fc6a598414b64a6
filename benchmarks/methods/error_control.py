"""Runs with a tolerance: time and error of each method and of the automatic choice."""

import time
import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np

import mbs
from benchmarks.methods.kernel_methods import suits
from benchmarks.references.cases import CASES, SAMPLES, exact_of, system_of
from benchmarks.shared.pages import Row, table

METHODS = ("ali3p", "radau_5", "runge_kutta_8", "semi_recursive", "semi_recursive_4")
CHOSEN = "auto"
TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-6)
QUICK_TOLERANCES = (1e-3,)
SCENES = tuple(name for name in CASES if name not in ("pendulum_1000s", "four_bar_200"))
SLOW = 1e-3
"""Tolerance below which ALi3-P, of order two, is left out."""
MAX_ERROR = 10.0  # largest error of an accurate run, relative to the tolerance
MAX_TIME_RATIO = 2.0  # largest time of a good choice, relative to the best method
REPEATS = 5
LONG = 0.5  # s: longer runs are made once


def measure(scene: str, tolerance: float, method: str, repeats: int) -> dict[str, Any]:
    """Row of a run with its errors, and the least time of some repeats."""
    case, system = CASES[scene], system_of(scene)
    row: dict[str, Any] = {"scene": scene, "tolerance": tolerance, "method": method}
    row |= dict.fromkeys(("error_over_tolerance", "cpu_ms", "ratio", "warned"))
    times = np.linspace(0.0, case.end, SAMPLES + 1)
    cpu_times = []
    for _ in range(repeats):
        with warnings.catch_warnings(record=True) as caught_warnings:
            warnings.simplefilter("always")
            begin = time.process_time()
            try:
                run = mbs.simulate(system, case.end, tolerance=tolerance, method=method, times=times, progress=False)
            except mbs.SimulationError as error:
                return row | {"ended": f"refused at {error.time:.4g} s: {error}"}
        cpu_times.append(time.process_time() - begin)
        if cpu_times[0] > LONG:
            break
    control = run.control
    assert control is not None
    values = np.column_stack([run[s] for s in case.sensors])
    error = float(np.linalg.norm(values - exact_of(scene), axis=1).max()) / control.length
    return row | {
        "method": method if method != CHOSEN else f"{CHOSEN}: {control.method}",
        "error_over_tolerance": error / tolerance,
        "estimate_over_tolerance": control.error / tolerance,
        "cpu_ms": 1e3 * min(cpu_times),
        "steps": control.steps,
        "rejected": control.rejected,
        "runs": control.runs,
        "warned": "yes" if caught_warnings else "",
        "ended": "finished",
    }


def methods_of(scene: str, tolerance: float) -> list[str]:
    """Methods of the table that can simulate a scene."""
    names = [m for m in METHODS if suits(m, CASES[scene].conservative, system_of(scene))]
    return [m for m in names if m != "ali3p" or tolerance >= SLOW]


def compare(rows: list[dict[str, Any]]) -> None:
    """Set the ratio of each row: its time divided by the least time of an accurate run."""
    accurate_times = [r["cpu_ms"] for r in rows if r["cpu_ms"] and r["error_over_tolerance"] <= MAX_ERROR]
    for row in rows:
        if accurate_times and row["cpu_ms"]:
            row["ratio"] = row["cpu_ms"] / min(accurate_times)


def control_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Table of the times of the automatic choice and of the best method at each tolerance."""
    lines = []
    for r in rows:
        if not r["method"].startswith(CHOSEN):
            continue
        accurate_rows = [
            x
            for x in rows
            if (x["scene"], x["tolerance"]) == (r["scene"], r["tolerance"])
            and not x["method"].startswith(CHOSEN)
            and x["cpu_ms"]
            and x["error_over_tolerance"] <= MAX_ERROR
        ]
        best = min(accurate_rows, key=lambda x: x["cpu_ms"], default=None)
        miss = [
            label
            for label, applies in (("slow", (r["ratio"] or 0.0) > MAX_TIME_RATIO), ("refused", not r["cpu_ms"]))
            if applies
        ]
        if (r["error_over_tolerance"] or 0.0) > MAX_ERROR:
            miss.append("wrong" + (", warned" if r["warned"] else ""))
        lines.append(
            {**r, "chosen": r["method"].removeprefix(f"{CHOSEN}: "), "best": best and best["method"]}
            | {"best_ms": best and best["cpu_ms"], "miss": ", ".join(miss)}
        )
    columns = {"scene": "", "tolerance": ".0e", "chosen": "", "error_over_tolerance": ".2g", "cpu_ms": ".3g"}
    return {"control": table(lines, columns | {"best": "", "best_ms": ".3g", "ratio": ".2f", "miss": ""})}
