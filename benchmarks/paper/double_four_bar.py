"""The N-four-bar through its singular positions: rows over methods and steps, the paper's Table 1, chart."""

from __future__ import annotations

import time
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

WINDOWS = (1, 2, 40, 200, 1000)
COLUMNS = {
    "method": "",
    "N": "d",
    "h_s": "g",
    "energy_deviation_J": ".3g",
    "position_error_m": ".2e",
    "iterations_mean": ".2f",
    "iterations_max": "d",
    "us_per_step": ".2f",
    "us_reported": ".2f",
    "wall_s": ".2e",
    "realtime_factor": ".0f",
    "failed_at_s": ".3f",
}
END = 10.0  # s
REPEATS, FEW_REPEATS = 15, 3
LONG = 0.2  # s of wall time beyond which a few repeats must do
SHORT = 2  # N up to which runs that record every state are timed too
LOST = 1.0  # m: beyond it the phase is lost and the chart has no point
PAPER = {0.01: (-0.21, 0.86), 0.03: (-0.83, 0.37), 0.05: (-9.03, 0.26)}  # s: (J, s), Table 1
SHOWN = 3e-3  # s: a run that takes less is seldom interrupted, and its time is told
METHODS = {
    "ALi3-P": mbs.Settings(),
    "ALi3-P, tolerance 1e-12": mbs.Settings(tolerance_r=1e-12, tolerance_phi=1e-12),
    # the residual that the paper's update (16) reaches in double precision
    "ALi3-P, paper's update": mbs.Settings(update="paper", tolerance_r=1e-7),
    "ALi3-P, paper's start value": mbs.Settings(predictor="acceleration"),
    "energy-momentum": mbs.Settings(method="energy_momentum"),
    "ALi3 without projections": mbs.Settings(project=False),
}
STEPS = (0.1, 0.05, 0.03, 0.01, 0.005, 0.002, 0.001)
FEW_STEPS = (0.05, 0.01, 0.002)  # for the long chains


def measure(system: mbs.System, windows: int, method: str, h: float, compile_s: float) -> dict[str, Any]:
    """One row: accuracy, iterations and a first time, which also warms up; `time_rows` takes the others.

    `method`: one of `METHODS`; `h`: in s; `compile_s`: what compile() took, s.
    """
    settings, failed = METHODS[method], None
    try:
        run = mbs.simulate(system, END, h, settings=settings, progress=False, estimate_error=False)
    except mbs.SimulationError as error:
        failed = error.time
    row: dict[str, Any] = {
        "method": method,
        "N": windows,
        "h_s": h,
        "energy_deviation_J": None,
        "position_error_m": None,
        "iterations_mean": None,
        "iterations_max": None,
        "us_per_step": None,
        "us_reported": None,
        "wall_s": None,
        "realtime_factor": None,
        "failed_at_s": failed,
        "compile_s": compile_s,
        "coordinates": system.nq,
        "rows": system.nc,
        "factor_nonzeros": system.report["factor_nonzeros"],
    }
    if failed is not None or run.report is None:
        return row
    energy = run["energy.total"]
    place = np.column_stack([run["B0.position.x"], run["B0.position.y"]])
    return row | {
        "energy_deviation_J": _largest(energy - energy[0]),
        "position_error_m": float(np.linalg.norm(place - four_bar(windows, run.t), axis=1).max()),
        "iterations_mean": run.report.mean_iterations,
        "iterations_max": run.report.max_iterations,
        "wall_s": run.wall_s,
        "halvings": run.report.halvings,
    }


def _largest(x: np.ndarray) -> float:
    """The entry farthest from zero, with its sign."""
    return float(x[np.abs(x).argmax()])


def time_rows(rows: Sequence[dict[str, Any]], systems: dict[int, mbs.System], repeats: int) -> None:
    """Fill in the times: the least of repeats through all rows, so that a disturbance does not fall on one row alone.

    Only the last state is recorded; of the short mechanisms also every state, for `us_reported`.
    """
    good = [row for row in rows if row["failed_at_s"] is None]
    walls: dict[tuple[int, bool], list[float]] = {(k, whole): [] for k in range(len(good)) for whole in (False, True)}
    for turn, k, whole in watched([(turn, *key) for turn in range(repeats) for key in walls]):
        row = good[k]
        if (turn < FEW_REPEATS or row["wall_s"] < LONG) and (row["N"] <= SHORT or not whole):
            every = 1 if whole else round(END / row["h_s"])
            settings = METHODS[row["method"]]
            run = mbs.simulate(
                systems[row["N"]], END, row["h_s"], settings=settings, every=every, progress=False, estimate_error=False
            )
            walls[k, whole].append(run.wall_s)
    for k, row in enumerate(good):
        wall, per_step = min(walls[k, False]), 1e6 / round(END / row["h_s"])
        row |= {"wall_s": wall, "us_per_step": per_step * wall, "realtime_factor": END / wall}
        if walls[k, True]:
            row["us_reported"] = per_step * min(walls[k, True])


def measure_all(windows: Sequence[int], repeats: int = REPEATS) -> list[dict[str, Any]]:
    """All rows, in the order of the table."""
    rows, systems = [], {}
    for n in windows:
        begin = time.perf_counter()
        system = systems[n] = mbs.compile(double_four_bar.build(n))
        compile_s = time.perf_counter() - begin
        print(f"N = {n}: {system.nq} coordinates, {system.nc} rows, compiled in {compile_s:.2f} s", flush=True)
        methods = METHODS if n <= SHORT else [m for m in METHODS if METHODS[m].project]
        todo = [(method, h) for method in methods for h in (STEPS if n <= 40 else FEW_STEPS)]
        rows += [measure(system, n, method, h, compile_s) for method, h in watched(todo)]
    time_rows(rows, systems, repeats)
    return rows


def four_bar_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """The paper's Table 1 beside the rows of N = 2."""
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
                "ours ms": 1e3 * r["wall_s"] if r["wall_s"] < SHOWN else None,
            }
        )
    return {"table 1": table(lines, dict.fromkeys(lines[0], ".3g"))}


def draw(rows: Sequence[Row], file: Path) -> None:
    """Position error against wall time, log-log; colours of Okabe and Ito, a marker per method, a panel per N."""
    plt = pyplot()
    look = dict(
        zip(
            METHODS,
            (
                ("#0072B2", "o"),
                ("#009E73", "s"),
                ("#E69F00", "^"),
                ("#000000", "v"),
                ("#CC79A7", "D"),
                ("#D55E00", "x"),
            ),
            strict=True,
        )
    )
    processor = machine()["processor"]
    windows = [n for n in (2, 40) if any(r["N"] == n for r in rows)]
    figure, axes = plt.subplots(
        1, len(windows), figsize=(4.6 * len(windows), 4.4), sharey=True, squeeze=False, layout="constrained"
    )
    for ax, n in zip(axes[0], windows, strict=True):
        for method, (colour, marker) in look.items():
            part = [r for r in rows if r["N"] == n and r["method"] == method and METHODS[method].project]
            part = [r for r in part if r["wall_s"] and r["position_error_m"] < LOST]
            if not part:
                continue
            x, y = ([r[key] for r in part] for key in ("wall_s", "position_error_m"))
            ax.loglog(x, y, marker=marker, color=colour, label=method, linewidth=1.6, markersize=6, fillstyle="none")
            if method == "ALi3-P":
                for r in part:
                    ax.annotate(
                        f"{1e3 * r['h_s']:g} ms",
                        (r["wall_s"], r["position_error_m"]),
                        xytext=(-7, -4),
                        textcoords="offset points",
                        ha="right",
                        va="top",
                        fontsize=8,
                    )
        ax.set_title(f"N = {n}: {2 * n + 1} links, 10 s, ten singular positions", fontsize=10)
        ax.set_xlabel(f"wall time, s ({processor})")
        ax.grid(True, which="major", alpha=0.35)
        ax.margins(x=0.16)
    axes[0, 0].set_ylabel("largest position error of B0, m")
    axes[0, 0].legend(fontsize=8, loc="lower left")
    save_chart(figure, file)
