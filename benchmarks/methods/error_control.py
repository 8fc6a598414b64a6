"""Runs to a tolerance: what each method and the choice of the method took and reached."""

from __future__ import annotations

import time
import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np

import mbs
from benchmarks.methods.kernel_methods import suits
from benchmarks.references.cases import CASES, SAMPLES, exact_of, system_of

METHODS = ("ali3p", "radau_5", "runge_kutta_8", "semi_recursive", "semi_recursive_4")
CHOSEN = "auto"
SLOW = 1e-3
"""Below this tolerance ALi3-P, of order two, is left out where others can be used."""
MOST_ERROR, MOST_TIME = 10.0, 2.0
REPEATS, LONG = 5, 0.5  # s: longer runs are made once
TABLE = {
    "scene": "",
    "tolerance": ".0e",
    "method": "",
    "error_over_tolerance": ".2g",
    "estimate_over_tolerance": ".2g",
    "cpu_ms": ".3g",
    "steps": "d",
    "rejected": "d",
    "runs": "d",
    "ratio": ".2f",
    "warned": "",
    "ended": "",
}


def measure(scene: str, tolerance: float, method: str, repeats: int) -> dict[str, Any]:
    """One row: the run with its errors, and the least time of a few."""
    case, system = CASES[scene], system_of(scene)
    row: dict[str, Any] = dict.fromkeys(TABLE) | {"scene": scene, "tolerance": tolerance, "method": method}
    times = np.linspace(0.0, case.end, SAMPLES + 1)
    spent = []
    for _ in range(repeats):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            begin = time.process_time()
            try:
                run = mbs.simulate(system, case.end, tolerance=tolerance, method=method, times=times, progress=False)
            except mbs.SimulationError as error:
                return row | {"ended": f"refused at {error.time:.4g} s: {error}"}
        spent.append(time.process_time() - begin)
        if spent[0] > LONG:
            break
    control = run.control
    assert control is not None
    found = np.column_stack([run[s] for s in case.sensors])
    error = float(np.linalg.norm(found - exact_of(scene), axis=1).max()) / control.length
    return row | {
        "method": method if method != CHOSEN else f"{CHOSEN}: {control.method}",
        "error_over_tolerance": error / tolerance,
        "estimate_over_tolerance": control.error / tolerance,
        "cpu_ms": 1e3 * min(spent),
        "steps": control.steps,
        "rejected": control.rejected,
        "runs": control.runs,
        "warned": "yes" if caught else "",
        "ended": "finished",
    }


def methods_of(scene: str, tolerance: float) -> list[str]:
    """Methods of the table that take a scene."""
    names = [m for m in METHODS if suits(m, CASES[scene].conservative, system_of(scene))]
    return [m for m in names if m != "ali3p" or tolerance >= SLOW]


def compare(rows: list[dict[str, Any]]) -> None:
    """Fills in the time of each row over the best that kept its error."""
    good = [r["cpu_ms"] for r in rows if r["cpu_ms"] and r["error_over_tolerance"] <= MOST_ERROR]
    for row in rows:
        if good and row["cpu_ms"]:
            row["ratio"] = row["cpu_ms"] / min(r for r in good)


def misses(rows: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Rows of the choice that are costly or wrong, and of any method that are wrong without a warning."""
    found = []
    for row in rows:
        chosen = row["method"].startswith(CHOSEN)
        wrong = row["error_over_tolerance"] is not None and row["error_over_tolerance"] > MOST_ERROR
        costly = row["ratio"] is not None and row["ratio"] > MOST_TIME
        if (chosen and (costly or wrong or row["ended"] != "finished")) or (wrong and not row["warned"]):
            found.append(row)
    return found
