"""The N-four-bar through its singular positions: rows over methods and steps, the paper's Table 1, chart."""

import itertools
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

import mbs
from benchmarks.references.motions import four_bar
from benchmarks.shared.command import pyplot, save_chart, watched
from benchmarks.shared.machine import machine
from benchmarks.shared.pages import Row, table
from mbs.scenes import double_four_bar

WINDOWS = (2, 40)  # N
END = 10.0  # s
REPEATS = 15
_STYLES = (("#0072B2", "o"), ("#009E73", "s"), ("#E69F00", "^"), ("#000000", "v"), ("#CC79A7", "D"))
"""Colour of Okabe and Ito, and marker of each of `METHODS`."""
MAX_DRAWN_ERROR = 1.0  # m
PAPER = {0.01: (-0.21, 0.86), 0.03: (-0.83, 0.37), 0.05: (-9.03, 0.26)}
"""Energy error, J, and time in Matlab, s, by step, s: Table 1 of the paper."""
MAX_TIME = 3e-3
"""Longest time that the table has, s: shorter runs are seldom interrupted by other programs."""
METHODS = {
    "ALi3-P": mbs.Settings(),
    "ALi3-P, tolerance 1e-12": mbs.Settings(tolerance_r=1e-12, tolerance_phi=1e-12),
    # smallest residual of the paper's update (16) in double precision
    "ALi3-P, paper's update": mbs.Settings(update="paper", tolerance_r=1e-7),
    "ALi3-P, paper's start value": mbs.Settings(predictor="acceleration"),
    "energy-momentum": mbs.Settings(method="energy_momentum"),
}
STEPS = (0.1, 0.05, 0.03, 0.01, 0.005, 0.002, 0.001)


def measure(system: mbs.System, windows: int, method: str, h: float) -> dict[str, Any]:
    """Row of a run: accuracy, iterations and a first time, to warm up; `time_rows` measures the times.

    `method`: one of `METHODS`; `h`: step, s.
    """
    row: dict[str, Any] = {"N": windows, "method": method, "h_s": h, "failed_at_s": None}
    try:
        run = mbs.simulate(system, END, h, settings=METHODS[method], progress=False, estimate_error=False)
    except mbs.SimulationError as error:
        return row | {"failed_at_s": error.time, "position_error_m": None, "wall_s": None}
    assert run.report is not None
    energy = run["energy.total"] - run["energy.total"][0]
    position = np.column_stack([run["B0.position.x"], run["B0.position.y"]])
    return row | {
        "energy_deviation_J": float(energy[np.abs(energy).argmax()]),  # with its sign
        "position_error_m": float(np.linalg.norm(position - four_bar(windows, run.t), axis=1).max()),
        "iterations_mean": run.report.mean_iterations,
        "iterations_max": run.report.max_iterations,
        "wall_s": run.wall_s,
    }


def time_rows(rows: Sequence[dict[str, Any]], systems: dict[int, mbs.System], repeats: int) -> None:
    """Set the times of the rows: the least of repeats through all rows, so that disturbances affect all of them.

    Only the last state of a run is recorded.
    """
    good = [row for row in rows if row["failed_at_s"] is None]
    walls: list[list[float]] = [[] for _ in good]
    for _, k in watched([(turn, k) for turn in range(repeats) for k in range(len(good))]):
        system, h, settings = systems[good[k]["N"]], good[k]["h_s"], METHODS[good[k]["method"]]
        every = round(END / h)
        run = mbs.simulate(system, END, h, settings=settings, every=every, progress=False, estimate_error=False)
        walls[k].append(run.wall_s)
    for row, times in zip(good, walls, strict=True):
        row["wall_s"] = min(times)


def measure_all(windows: Sequence[int], repeats: int) -> list[dict[str, Any]]:
    """Rows of all systems, methods and steps."""
    systems = {n: mbs.compile(double_four_bar.build(n)) for n in windows}
    rows = [measure(systems[n], n, *run) for n, *run in watched(list(itertools.product(windows, METHODS, STEPS)))]
    time_rows(rows, systems, repeats)
    return rows


def four_bar_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """The rows of N = 2 beside the paper's Table 1."""
    lines = []
    for r in sorted((r for r in rows if r["N"] == 2 and r["method"] == "ALi3-P"), key=lambda r: -r["h_s"]):
        energy, wall = PAPER.get(r["h_s"], (None, None))
        lines.append(
            {
                "h s": r["h_s"],
                "paper dE J": energy,
                "ours dE J": r["energy_deviation_J"],
                "largest position error m": r["position_error_m"],
                "iterations, mean (most)": f"{r['iterations_mean']:.2f} ({r['iterations_max']})",
                "paper s (Matlab)": wall,
                "ours ms": 1e3 * r["wall_s"] if r["wall_s"] < MAX_TIME else None,
            }
        )
    return {"table 1": table(lines, dict.fromkeys(lines[0], ".3g"))}


def draw(rows: Sequence[Row], file: Path) -> None:
    """Draw position errors over wall time, log-log, a panel for each N."""
    windows = list(dict.fromkeys(r["N"] for r in rows))
    figure, axes = pyplot().subplots(
        1, len(windows), figsize=(4.6 * len(windows), 4.4), sharey=True, squeeze=False, layout="constrained"
    )
    for ax, n in zip(axes[0], windows, strict=True):
        for method, (colour, marker) in zip(METHODS, _STYLES, strict=True):
            method_rows = [r for r in rows if r["N"] == n and r["method"] == method]
            method_rows = [r for r in method_rows if r["wall_s"] and r["position_error_m"] < MAX_DRAWN_ERROR]
            x, y = ([r[key] for r in method_rows] for key in ("wall_s", "position_error_m"))
            ax.loglog(x, y, marker=marker, color=colour, label=method, linewidth=1.6, markersize=6, fillstyle="none")
            for r in method_rows if method == "ALi3-P" else ():
                style = {"xytext": (-7, -4), "textcoords": "offset points", "ha": "right", "va": "top", "fontsize": 8}
                ax.annotate(f"{1e3 * r['h_s']:g} ms", (r["wall_s"], r["position_error_m"]), **style)
        ax.set_title(f"N = {n}: {2 * n + 1} links, 10 s, ten singular positions", fontsize=10)
        ax.set_xlabel(f"wall time, s ({machine()['processor']})")
        ax.grid(True, which="major", alpha=0.35)
        ax.margins(x=0.16)
    axes[0, 0].set_ylabel("largest position error of B0, m")
    axes[0, 0].legend(fontsize=8, loc="lower left")
    save_chart(figure, file)
