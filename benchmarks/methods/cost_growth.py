"""Cost of the N-four-bar over N, with fitted exponents."""

import statistics
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

import mbs
from benchmarks.shared.command import pyplot, save_chart, watched
from benchmarks.shared.machine import machine
from benchmarks.shared.pages import Row, table
from mbs.scenes import double_four_bar

STEP = 0.01  # s
END = 0.6  # s: before the first singular position
FITTED_FROM = 10  # N: the fixed cost of smaller systems counts
WINDOWS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
REPEATS = 9
METHODS = ("ali3p", "energy_momentum")
EXPONENTS = ("us_per_step", "us_per_iteration", "system_bytes", "factor_nonzeros")


def measure(windows: Sequence[int], repeats: int) -> list[dict[str, Any]]:
    """Rows of the N-four-bars by N and method: sizes, and times of a step.

    `windows`: numbers N; `repeats`: timed runs through all rows, of which the median counts, after one to warm up.
    """
    names, systems = [], []
    for n in watched(windows):
        system = mbs.compile(double_four_bar.build(n))
        for method in METHODS:
            names.append({"N": n, "method": method})
            systems.append((system, mbs.Settings(method=method)))
    steps = round(END / STEP)
    walls: list[list[float]] = [[] for _ in names]
    iterations = [0.0] * len(names)
    for turn, k in watched([(turn, k) for turn in range(repeats + 1) for k in range(len(names))]):
        system, settings = systems[k]
        run = mbs.simulate(system, END, STEP, settings=settings, every=steps, progress=False, estimate_error=False)
        iterations[k] = run.report.mean_iterations
        if turn:
            walls[k].append(run.wall_s / steps)
    rows = []
    for name, (system, _), times, mean in zip(names, systems, walls, iterations, strict=True):
        sizes = {"coordinates": system.nq, "factor_nonzeros": system.report["factor_nonzeros"]}
        wall = 1e6 * statistics.median(times)
        costs = {"iterations": mean, "us_per_step": wall, "us_per_iteration": wall / mean}
        rows.append({**name, **sizes, "system_bytes": len(system.kernel_bytes()), **costs})
    return rows


def exponents(rows: Sequence[Row]) -> dict[str, float]:
    """Exponents b of the fits ``cost = a N^b``."""
    x = np.log([r["N"] for r in rows])
    return {key: float(np.polyfit(x, np.log([r[key] for r in rows]), 1)[0]) for key in EXPONENTS}


def growth_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Tables of cost over N, and of its exponents from `FITTED_FROM` windows on."""
    exponent_rows = []
    for method in METHODS:
        method_rows = [r for r in rows if r["method"] == method and r["N"] >= FITTED_FROM]
        exponent_rows.append({"method": method} | exponents(method_rows))
    columns = {"N": "d", "method": "", "us_per_step": ".3g", "iterations": ".2f", "factor_nonzeros": "d"}
    return {
        "growth": table(rows, columns | {"system_bytes": "d"}),
        "exponents": table(exponent_rows, {"method": ""} | dict.fromkeys(EXPONENTS, ".2f")),
    }


def draw(rows: Sequence[Row], file: Path) -> None:
    """Draw time per step and non-zeros over N, log-log, with a line of slope one."""
    plt = pyplot()
    figure, ax = plt.subplots(figsize=(6.2, 4.4), layout="constrained")
    for method, colour, marker in zip(METHODS, ("#0072B2", "#CC79A7"), "ov", strict=True):
        method_rows = [r for r in rows if r["method"] == method]
        x = [r["N"] for r in method_rows]
        ax.loglog(
            x, [r["us_per_step"] for r in method_rows], f"{marker}-", color=colour, label=f"{method}: µs per step"
        )
    method_rows = [r for r in rows if r["method"] == METHODS[0]]
    x = np.array([r["N"] for r in method_rows], dtype=float)
    ax.loglog(x, [r["factor_nonzeros"] for r in method_rows], "s--", color="#009E73", label="non-zeros of the factor")
    ax.loglog(x, method_rows[-1]["us_per_step"] * x / x[-1], ":", color="black", label="slope 1")
    ax.set_xlabel(f"N of the N-four-bar ({machine()['processor']})")
    ax.grid(True, which="major", alpha=0.35)
    ax.legend(fontsize=8)
    save_chart(figure, file)
