"""Cost of the N-four-bar and of the car's frame over their size, with fitted exponents."""

import statistics
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

STEP = 0.01  # s
END = 0.6  # s: before the first singular position
CHASSIS_STEP = 0.005  # s
CHASSIS_STEPS = 100
FITTED_FROM = 10  # N: the fixed cost of smaller systems counts
WINDOWS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
REPEATS = 9
MODES = (5, 10, 20, 50, 100, 200)  # dynamic ones of the chassis, beside 60 static and 6 inertia modes
METHODS = ("ali3p", "energy_momentum")
EXPONENTS = ("us_per_step", "us_per_iteration", "system_bytes", "factor_nonzeros")
TIMES = ("us_per_step", "us_per_iteration")
SHOWN = {"coordinates": "d", "factor_nonzeros": "d", "system_bytes": "d", "iterations": ".2f"}


def measure(windows: Sequence[int], repeats: int) -> list[dict[str, Any]]:
    """Rows of the N-four-bars."""
    names, systems = [], []
    for n in watched(windows):
        system = mbs.compile(double_four_bar.build(n))
        for method in METHODS:
            names.append({"N": n, "method": method})
            systems.append((system, mbs.Settings(method=method)))
    return _timed(names, systems, STEP, round(END / STEP), repeats)


def chassis(modes: Sequence[int], repeats: int) -> list[dict[str, Any]]:
    """Rows of the car's frame alone in free rotation: the cost of its modes without the suspension."""
    flexible = load("prototype").flexible_frame
    names, systems = [], []
    for count in watched(modes):
        m = mbs.Model("thrown chassis", gravity=(0.0, 0.0, -9.81))
        reduced = craig_bampton(
            flexible.model, flexible.reference, flexible.interfaces, count, inertia_modes=True, damping=flexible.damping
        )
        body = m.flexible_body("chassis", reduced)
        m.initial_velocity(body, (5.0, 0.0, 3.0), (0.3, 0.5, 2.0))
        m.sense_energy("energy.total", "total")
        system = mbs.compile(m)
        names.append({"dynamic_modes": count, "modes": len(system.arrays["flex_mode"])})
        systems.append((system, mbs.Settings()))
    return _timed(names, systems, CHASSIS_STEP, CHASSIS_STEPS, repeats)


def _timed(
    names: Sequence[Row], systems: Sequence[tuple[mbs.System, mbs.Settings]], h: float, steps: int, repeats: int
) -> list[dict[str, Any]]:
    """Rows with sizes and times of a step; times are medians over repeats through all rows, after one to warm up."""
    walls: list[list[float]] = [[] for _ in names]
    iterations = [0.0] * len(names)
    for turn, k in watched([(turn, k) for turn in range(repeats + 1) for k in range(len(names))]):
        system, settings = systems[k]
        run = mbs.simulate(system, steps * h, h, settings=settings, every=steps, progress=False, estimate_error=False)
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


def exponents(rows: Sequence[Row], size: str) -> dict[str, float]:
    """Exponents b of the fits ``cost = a size^b``."""
    x = np.log([r[size] for r in rows])
    return {key: float(np.polyfit(x, np.log([r[key] for r in rows]), 1)[0]) for key in EXPONENTS}


def growth_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Tables of cost over size and of its exponents, for four-bars from `FITTED_FROM` windows."""
    four_bars, frames = ([r for r in rows if r["table"] == name] for name in ("windows", "chassis"))
    exponent_rows = []
    for method in METHODS:
        method_rows = [r for r in four_bars if r["method"] == method and r["N"] >= FITTED_FROM]
        exponent_rows.append({"method": method} | exponents(method_rows, "N"))
    columns = {"N": "d", "method": "", "us_per_step": ".3g", "iterations": ".2f", "factor_nonzeros": "d"}
    of_frame = dict.fromkeys(("dynamic_modes", "modes"), "d") | SHOWN | dict.fromkeys(TIMES, ".0f")
    slopes = ", ".join(f"{key.replace('_', ' ')} {value:.2f}" for key, value in exponents(frames, "modes").items())
    caption = f"Steps of {CHASSIS_STEP:g} s. Exponents b of cost = a n^b in all modes n: {slopes}."
    return {
        "growth": table(four_bars, columns | {"system_bytes": "d"}),
        "exponents": table(exponent_rows, {"method": ""} | dict.fromkeys(EXPONENTS, ".2f")),
        "chassis growth": f"{table(frames, of_frame)}\n\n{caption}",
    }


def draw(rows: Sequence[Row], file: Path) -> None:
    """Draw time per step and non-zeros over N, log-log, with a line of slope one."""
    rows = [r for r in rows if r["table"] == "windows"]
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
