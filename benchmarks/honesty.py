"""Whether a run says that it is wrong: ``python -m benchmarks.honesty [--json FILE] [--quick]``.

Every scene, method and manoeuvre of the car at coarse and fine steps, as `mbs.simulate` runs it: the true error beside
the error told. A run is wrong when a judged sensor is off by more than 5 % of the largest range in its unit at one of
51 instants; a warning then is right, and is a false alarm elsewhere.
"""

from __future__ import annotations

import sys
import time
import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np

import mbs
from benchmarks.command import parser_of, save_rows, watched
from benchmarks.common import describe, print_table
from benchmarks.honesty_scenes import SCENES
from benchmarks.kernel_methods import TITLES
from mbs.accuracy import WRONG_BALANCE, WRONG_ERROR

LONG = 12.0  # s of processor time beyond which a method is not run with a finer step
HOLDS = 1e-3  # of the range: a smaller error need not be told
FACTOR = 10.0  # by which an error may be larger than what was told
QUICK = {"pendulum": (0.2, 0.05, 0.01), "printed_crank_slider": (1e-3, 2e-5), "tumbling_body": (0.01, 0.0002)}
TABLE = {
    "scene": "",
    "method": "",
    "h_s": ".4g",
    "ended": "",
    "error": ".1e",
    "told": ".1e",
    "balance": ".1e",
    "halvings_per_step": ".2g",
    "repeated": "",
    "verdict": "",
    "cpu_s": ".2g",
}
VERDICTS = ("right, quiet", "false alarm", "wrong, said", "wrong, missed")
SUMMARY = {
    "method": "",
    "runs": "d",
    "refused": "d",
    "right": "d",
    "false alarms": "d",
    "wrong": "d",
    "missed": "d",
    "said by the balance": "d",
    "right without a repeat": ".0%",
    "off by more than told": "d",
}


def measure(name: str, method: str, h: float) -> dict[str, Any]:
    """One run."""
    scene = SCENES[name]
    row: dict[str, Any] = {"scene": name, "method": method, "h_s": h, "ended": "refused", "verdict": "refused"}
    row |= dict.fromkeys(("error", "told", "balance", "halvings_per_step", "warning"))
    row["repeated"] = ""
    begin = time.process_time()
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", mbs.AccuracyWarning)
            found = scene.run(method, h)
    except mbs.SimulationError as refused:
        return row | {"reason": str(refused), "cpu_s": time.process_time() - begin}
    accuracy = found.accuracy
    assert accuracy is not None
    row["cpu_s"] = time.process_time() - begin
    error, told = scene.error(found)
    wrong, said = not error <= WRONG_ERROR, bool(caught)
    return row | {
        "ended": "finished",
        "error": error,
        "told": told if np.isfinite(told) else None,
        "balance": accuracy.energy_balance,
        "halvings_per_step": accuracy.halvings_per_step,
        "repeated": "yes" if accuracy.repeated_with is not None else "no",
        "verdict": VERDICTS[2 * wrong + (said != wrong if wrong else said)],
        "warning": accuracy.message,
    }


def summary(rows: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Per method: wrong runs caught and missed, right ones disturbed."""
    lines = []
    for method in dict.fromkeys(r["method"] for r in rows):
        part = [r for r in rows if r["method"] == method]
        done = [r for r in part if r["ended"] == "finished"]
        right = [r for r in done if r["error"] <= WRONG_ERROR]
        quiet = sum(r["repeated"] == "no" for r in right)
        told = [r for r in done if r["told"] is not None and r["error"] > HOLDS]
        lines.append(
            {
                "method": TITLES[method],
                "runs": len(part),
                "refused": len(part) - len(done),
                "right": len(right),
                "false alarms": sum(r["verdict"] == VERDICTS[1] for r in done),
                "wrong": len(done) - len(right),
                "missed": sum(r["verdict"] == VERDICTS[3] for r in done),
                "said by the balance": sum((r["balance"] or 0.0) > WRONG_BALANCE for r in done),
                "right without a repeat": quiet / len(right) if right else None,
                "off by more than told": sum(r["error"] > FACTOR * r["told"] for r in told),
            }
        )
    return lines


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("honesty", __doc__)
    parser.add_argument("--scene", action="append", choices=list(SCENES), help="a scene; may be given again")
    parser.add_argument("--method", action="append", choices=list(TITLES), help="a method; may be given again")
    parser.add_argument("--quick", action="store_true", help="three scenes, the default method, a few steps")
    parser.add_argument("--longest", type=float, default=LONG, metavar="S", help="of a run, before finer steps stop")
    options = parser.parse_args(arguments)
    rows = []
    for name in watched(options.scene or list(QUICK if options.quick else SCENES)):
        methods = ["ali3p"] if options.quick else SCENES[name].methods()
        for method in [m for m in methods if not options.method or m in options.method]:
            for h in QUICK[name] if options.quick else SCENES[name].steps:
                rows.append(measure(name, method, h))
                if rows[-1]["cpu_s"] > options.longest:
                    break
    print_table(rows, TABLE)
    lines = summary(rows)
    print()
    print_table(lines, SUMMARY)
    save_rows(options.json, describe("honesty", mbs.Settings(), summary=lines), rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
