"""True errors of runs beside their estimates, and a summary of right, wrong and warned runs."""

from collections.abc import Sequence
from typing import Any

import mbs
from benchmarks.methods.families import CaseRun
from benchmarks.methods.honesty_scenes import SCENES
from benchmarks.methods.kernel_methods import TITLES
from benchmarks.methods.random_honesty import COUNTS, MAX_RATIO, NEGLIGIBLE, counts, judged_run
from benchmarks.shared.pages import Row, table
from mbs.kernel.header.limits import WRONG_ERROR

MAX_TIME = 12.0  # s of processor time from which a method is not run with smaller steps
QUICK = {"pendulum": (0.2, 0.05, 0.01), "printed_crank_slider": (1e-3, 2e-5), "tumbling_body": (0.01, 0.0002)}
SUMMARY = {"method": "", **COUNTS}


def measure(name: str, method: str, h: float) -> dict[str, Any]:
    """Row of a run with steps of h, s: true error, estimate and verdict."""
    scene, runs = SCENES[name], list[mbs.Trajectory]()

    def run() -> CaseRun:
        runs.append(scene.run(method, h))
        accuracy = runs[0].accuracy
        assert accuracy is not None
        return CaseRun(runs[0], accuracy.error, 1.0 + accuracy.check_cost, method)

    row = {
        "scene": name,
        "method": method,
        "h_s": h,
        **judged_run(f"{h:g} s", run, lambda _: scene.error(runs[0]), WRONG_ERROR),
    }
    accuracy = runs[0].accuracy if runs else None
    return row | {
        "ended": "finished" if runs else "refused",
        "balance": accuracy.energy_balance if accuracy else None,
        "halvings_per_step": accuracy.halvings_per_step if accuracy else None,
    }


def summary(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """Counts by method."""
    methods = dict.fromkeys(r["method"] for r in rows)
    return [{"method": TITLES[m], **counts([r for r in rows if r["method"] == m])} for m in methods]


def honesty_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Summary by method, list of false alarms, missed runs and low estimates, and table of the crank-slider."""
    reported = []
    for verdict in ("silently wrong", "false alarm"):
        results = [r for r in rows if r["verdict"] == verdict]
        for method in dict.fromkeys(r["method"] for r in results):
            runs = (f"{r['scene']} at {r['h_s']:g} s ({r['error']:.2g})" for r in results if r["method"] == method)
            reported.append(f"- {TITLES[method]}, {verdict}: {'; '.join(runs)}.")
    low_estimates = [
        f"{r['scene']} at {r['h_s']:g} s, {TITLES[r['method']]}: {r['error']:.1e}, estimate {r['estimate']:.1e}"
        for r in rows
        if r["estimate"] is not None and r["error"] > max(NEGLIGIBLE, MAX_RATIO * r["estimate"])
    ]
    reported += [f"- More than {MAX_RATIO:g} times the estimate: {'; '.join(low_estimates) or 'none'}."]
    return {
        "honesty": table(summary(rows), SUMMARY),
        "honesty exceptions": "\n".join(reported),
        "honesty crank": crank_table(rows),
    }


def crank_table(rows: Sequence[Row]) -> str:
    """Table of the crank-slider of the modelling page with the default method, by step."""
    crank = [r for r in rows if r["scene"] == "printed_crank_slider" and r["method"] == "ali3p"]
    columns = {"h_s": "g", "ended": "", "error": ".1e", "estimate": ".1e", "balance": ".1e", "halvings_per_step": ".2g"}
    return table(crank, columns | {"verdict": ""})
