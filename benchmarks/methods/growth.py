"""Cost of the N-four-bar and of the car's frame over their size, with fitted exponents."""

from __future__ import annotations

import statistics
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

import mbs
from benchmarks.shared.command import pyplot, save_chart, watched
from benchmarks.shared.machine import machine
from benchmarks.shared.pages import Row, table
from mbs.flexible.component_modes import craig_bampton
from mbs.scenes import double_four_bar
from mbs.vehicle import load

STEP, END = 0.01, 0.6  # s: up to before the first singular position
CHASSIS_STEP, CHASSIS_STEPS = 0.005, 100  # s
FITTED_FROM = 10  # N: below it the fixed cost of a step shows
WINDOWS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
REPEATS = 9
MODES = (5, 10, 20, 50, 100, 200)  # dynamic ones of the chassis, beside 60 static and 6 inertia modes
METHODS = ("ali3p", "energy_momentum")
EXPONENTS = ("us_per_step", "us_per_iteration", "system_bytes", "factor_nonzeros")
TIMES = {"us_per_step": ".3g", "us_per_iteration": ".3g"}
SIZES = {"coordinates": "d", "factor_nonzeros": "d", "system_bytes": "d", "state_bytes": "d", "iterations": ".2f"}
COLUMNS = {
    "windows": {"N": "d", "method": "", **SIZES, "rows": "d", "compile_s": ".2g", **TIMES},
    "chassis": {"dynamic_modes": "d", "modes": "d", **SIZES, **TIMES},
}


def measure(windows: Sequence[int], repeats: int) -> list[dict[str, Any]]:
    """All rows; times are medians over repeats through all of them."""
    steps = round(END / STEP)
    rows: list[dict[str, Any]] = []
    systems: dict[int, mbs.System] = {}
    for n in watched(windows):
        begin = time.perf_counter()
        system = systems[n] = mbs.compile(double_four_bar.build(n))
        compiled = time.perf_counter() - begin
        for method in METHODS:
            simulation = mbs.Simulation(system, settings=mbs.Settings(method=method))
            simulation.step(STEP, n=steps)
            report = simulation.report
            rows.append(
                {
                    "N": n,
                    "method": method,
                    "coordinates": system.nq,
                    "rows": system.nc,
                    "factor_nonzeros": system.report["factor_nonzeros"],
                    "system_bytes": len(system.kernel_bytes()),
                    "state_bytes": simulation.instance.system.state_size,
                    "compile_s": compiled,
                    "iterations": report.iterations / steps,
                }
            )
    walls: list[list[float]] = [[] for _ in rows]
    for turn, k in watched([(turn, k) for turn in range(repeats + 1) for k in range(len(rows))]):
        system, settings = systems[rows[k]["N"]], mbs.Settings(method=rows[k]["method"])
        run = mbs.simulate(system, END, STEP, settings=settings, every=steps, progress=False, estimate_error=False)
        if turn:
            walls[k].append(run.wall_s / steps)
    for row, times in zip(rows, walls, strict=True):
        wall = 1e6 * statistics.median(times)
        row |= {"us_per_step": wall, "us_per_iteration": wall / row["iterations"]}
    return rows


def chassis(modes: Sequence[int], repeats: int) -> list[dict[str, Any]]:
    """Rows of the car's frame alone, thrown and spinning: what its modes cost without the suspension."""
    flexible = load("prototype").flexible_frame
    model = flexible.model
    rows: list[dict[str, Any]] = []
    systems = []
    for count in watched(modes):
        m = mbs.Model("thrown chassis", gravity=(0.0, 0.0, -9.81))
        reduced = craig_bampton(
            model, flexible.reference, flexible.interfaces, count, inertia_modes=True, damping=flexible.damping
        )
        body = m.flexible_body("chassis", reduced)
        m.initial_velocity(body, (5.0, 0.0, 3.0), (0.3, 0.5, 2.0))
        m.sense_energy("energy.total", "total")
        system = mbs.compile(m)
        simulation = mbs.Simulation(system)
        simulation.step(CHASSIS_STEP, n=CHASSIS_STEPS)
        systems.append(system)
        rows.append(
            {
                "dynamic_modes": count,
                "modes": len(system.arrays["flex_mode"]),
                "coordinates": system.nq,
                "factor_nonzeros": system.report["factor_nonzeros"],
                "system_bytes": len(system.kernel_bytes()),
                "state_bytes": simulation.instance.system.state_size,
                "iterations": simulation.report.mean_iterations,
            }
        )
    walls: list[list[float]] = [[] for _ in rows]
    for turn, k in watched([(turn, k) for turn in range(repeats + 1) for k in range(len(systems))]):
        end = CHASSIS_STEPS * CHASSIS_STEP
        run = mbs.simulate(systems[k], end, CHASSIS_STEP, every=CHASSIS_STEPS, progress=False, estimate_error=False)
        if turn:
            walls[k].append(run.wall_s / CHASSIS_STEPS)
    for row, times in zip(rows, walls, strict=True):
        wall = 1e6 * statistics.median(times)
        row |= {"us_per_step": wall, "us_per_iteration": wall / row["iterations"]}
    return rows


def exponents(rows: Sequence[Row], size: str) -> dict[str, float]:
    """Fitted b of ``cost = a size^b``."""
    x = np.log([r[size] for r in rows])
    return {key: float(np.polyfit(x, np.log([r[key] for r in rows]), 1)[0]) for key in EXPONENTS}


def growth_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Growth and its exponents, of four-bars from `FITTED_FROM` windows on."""
    four_bars, frames = ([r for r in rows if r["table"] == name] for name in COLUMNS)
    fitted = []
    for method in METHODS:
        part = [r for r in four_bars if r["method"] == method and r["N"] >= FITTED_FROM]
        fitted.append({"method": method} | exponents(part, "N"))
    columns = {"N": "d", "method": "", "us_per_step": ".3g", "iterations": ".2f", "factor_nonzeros": "d"}
    of_frame = {key: COLUMNS["chassis"][key] for key in ("dynamic_modes", "modes", *SIZES) if key != "state_bytes"}
    slopes = ", ".join(f"{key.replace('_', ' ')} {value:.2f}" for key, value in exponents(frames, "modes").items())
    said = f"Steps of {CHASSIS_STEP:g} s. Exponents b of cost = a n^b in all modes n: {slopes}."
    return {
        "growth": table(four_bars, columns | {"system_bytes": "d"}),
        "exponents": table(fitted, {"method": ""} | dict.fromkeys(EXPONENTS, ".2f")),
        "chassis growth": f"{table(frames, of_frame | dict.fromkeys(TIMES, '.0f'))}\n\n{said}",
    }


def draw(rows: Sequence[Row], file: Path) -> None:
    """Time per step and non-zeros against N, log-log, with a line of slope one."""
    rows = [r for r in rows if r["table"] == "windows"]
    plt = pyplot()
    figure, ax = plt.subplots(figsize=(6.2, 4.4), layout="constrained")
    for method, colour, marker in zip(METHODS, ("#0072B2", "#CC79A7"), "ov", strict=True):
        part = [r for r in rows if r["method"] == method]
        x = [r["N"] for r in part]
        ax.loglog(x, [r["us_per_step"] for r in part], f"{marker}-", color=colour, label=f"{method}: µs per step")
    part = [r for r in rows if r["method"] == METHODS[0]]
    x = np.array([r["N"] for r in part], dtype=float)
    ax.loglog(x, [r["factor_nonzeros"] for r in part], "s--", color="#009E73", label="non-zeros of the factor")
    ax.loglog(x, part[-1]["us_per_step"] * x / x[-1], ":", color="black", label="slope 1")
    ax.set_xlabel(f"N of the N-four-bar ({machine()['processor']})")
    ax.grid(True, which="major", alpha=0.35)
    ax.legend(fontsize=8)
    save_chart(figure, file)
