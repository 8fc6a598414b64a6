"""Runs to a tolerance: ``python -m benchmarks.error_control [--scene NAME ...] [--json FILE] [--quick]``.

Every scene of the charts at several tolerances by every method that may be chosen, and by the choice itself: error
reached over the tolerance, processor time of all that `simulate` did, and that of the choice over that of the best
method that kept its error within ten tolerances. The last table holds the misses: a choice that took more than twice
the best, or an error beyond ten tolerances without a warning.
"""

from __future__ import annotations

import sys
import time
import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np

import mbs
from benchmarks.cases import CASES, SAMPLES, exact_of, system_of
from benchmarks.command import parser_of, save_rows, watched
from benchmarks.common import describe, print_table
from benchmarks.kernel_methods import suits

METHODS = ("ali3p", "radau_5", "runge_kutta_8", "semi_recursive", "semi_recursive_4")
CHOSEN = "auto"
TOLERANCES, QUICK_TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-6), (1e-3,)
QUICK = ("pendulum", "spatial_slider_crank")
SCENES = tuple(name for name in CASES if name not in ("pendulum_1000s", "four_bar_200"))
SLOW = 1e-3
"""Below this tolerance ALi3-P, of order two, is left out where others can be used."""
MOST_ERROR, MOST_TIME = 10.0, 2.0
ROUNDS, LONG = 5, 0.5  # s: longer runs are made once
TABLE = {
    "scene": "",
    "tolerance": ".0e",
    "method": "",
    "error_over_tolerance": ".2g",
    "told_over_tolerance": ".2g",
    "cpu_ms": ".3g",
    "steps": "d",
    "rejected": "d",
    "runs": "d",
    "ratio": ".2f",
    "warned": "",
    "ended": "",
}


def measure(scene: str, tolerance: float, method: str, rounds: int) -> dict[str, Any]:
    """One row: the run with its errors, and the least time of a few."""
    case, system = CASES[scene], system_of(scene)
    row: dict[str, Any] = dict.fromkeys(TABLE) | {"scene": scene, "tolerance": tolerance, "method": method}
    times = np.linspace(0.0, case.end, SAMPLES + 1)
    spent = []
    for _ in range(rounds):
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
        "told_over_tolerance": control.error / tolerance,
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
    """Rows of the choice that are dear or wrong, and of any method that are wrong without a warning."""
    found = []
    for row in rows:
        chosen = row["method"].startswith(CHOSEN)
        wrong = row["error_over_tolerance"] is not None and row["error_over_tolerance"] > MOST_ERROR
        dear = row["ratio"] is not None and row["ratio"] > MOST_TIME
        if (chosen and (dear or wrong or row["ended"] != "finished")) or (wrong and not row["warned"]):
            found.append(row)
    return found


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("error_control", __doc__)
    parser.add_argument("--scene", action="append", choices=list(CASES), help="a scene; may be given again")
    parser.add_argument("--quick", action="store_true", help="two scenes, one tolerance")
    options = parser.parse_args(arguments)
    rows: list[dict[str, Any]] = []
    for scene in options.scene or (QUICK if options.quick else SCENES):
        for tolerance in QUICK_TOLERANCES if options.quick else TOLERANCES:
            names = [*methods_of(scene, tolerance), CHOSEN]
            part = [measure(scene, tolerance, m, 1 if options.quick else ROUNDS) for m in watched(names)]
            compare(part)
            rows += part
            print_table(part, TABLE)
    wrong = misses(rows)
    chosen = sum(row["method"].startswith(CHOSEN) for row in rows)
    print(f"\n{chosen} choices, {len(wrong)} misses")
    print_table(wrong, TABLE)
    save_rows(options.json, describe("error_control", mbs.Settings(), misses=len(wrong)), rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
