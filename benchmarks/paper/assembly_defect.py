"""The four-bar with assembly defect against geometrically exact beams: differences, refusal with rigid bars, chart."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

import mbs
from benchmarks.references.assembly_defect import COMPONENTS, reference
from benchmarks.shared.command import pyplot, save_chart
from benchmarks.shared.pages import Row, table
from benchmarks.shared.timing import best_time
from benchmarks.shared.warned import wrong_on_purpose
from mbs.common.errors import ModelError
from mbs.scenes import assembly_defect_four_bar as scene

STEP = 0.01  # s, as the reference is stored
SHOWN = ((1, 2, 0), (1, 8, 6), (2, 2, 0), (4, 2, 0), (8, 2, 0))
"""Bodies a bar, elements of each, dynamic modes of each."""
# bodies per bar, elements per body, dynamic modes per body
CASES = ((1, 2, 0), (1, 4, 2), (1, 8, 6), (2, 2, 0), (2, 4, 2), (4, 2, 0), (4, 4, 2), (8, 2, 0))
RADII = (scene.RADIUS, 0.5 * scene.RADIUS)  # m
COLUMNS = {
    "bars": {
        "bodies_per_bar": "d",
        "elements": "d",
        "modes": "d",
        "coordinates": "d",
        "rows": "d",
        "T_error": ".2%",
        "My_error": ".2%",
        "Mz_error": ".2%",
        "largest_of_moment": ".2%",
        "iterations_mean": ".2f",
        "iterations_max": "d",
        "wall_s": ".3g",
        "realtime_factor": ".1f",
    },
    "largest moments, N m": {"diameter_mm": "g"} | dict.fromkeys(COMPONENTS, ".4g"),
}


def measure(case: tuple[int, int, int], repeats: int) -> tuple[dict[str, Any], mbs.Trajectory]:
    """One row, and the run it comes from, which without repeats is the one that is timed."""
    expected = reference()
    parts, elements, dynamic = case
    system = mbs.compile(scene.build(parts, elements, dynamic))
    run = mbs.simulate(system, scene.DURATION, STEP, progress=False)
    wall = run.wall_s
    if repeats:
        quick = partial(mbs.simulate, system, scene.DURATION, STEP, every=1000, progress=False)
        wall = best_time(lambda: quick().wall_s, repeats, warm_up=0)
    gaps = {c: float(np.max(np.abs(run[f"coupler.{c}"] - expected[c]))) for c in COMPONENTS}
    largest = max(np.max(np.abs(expected[c])) for c in COMPONENTS)
    row = {
        "bodies_per_bar": parts,
        "elements": elements,
        "modes": 12 + dynamic,
        "coordinates": system.nq,
        "rows": system.nc,
        **{f"{c}_error": gaps[c] / float(np.max(np.abs(expected[c]))) for c in COMPONENTS},
        "largest_of_moment": max(gaps.values()) / float(largest),
        "iterations_mean": run.report.iterations / run.report.steps,
        "iterations_max": run.report.max_iterations,
        "wall_s": wall,
        "realtime_factor": scene.DURATION / wall,
    }
    return row, run


def defect_table(rows: Sequence[Row]) -> str:
    """Sizes and errors by bodies, elements and modes, of `SHOWN`."""
    pairs = {"elements, modes of each": ("elements", "modes"), "coordinates, rows": ("coordinates", "rows")}
    lines = [
        row | {c: row[f"{c}_error"] for c in COMPONENTS} | {k: f"{row[a]}, {row[b]}" for k, (a, b) in pairs.items()}
        for row in rows
        if (row["bodies_per_bar"], row["elements"], row["modes"] - 12) in SHOWN
    ]
    columns = {"bodies_per_bar": "d", "elements, modes of each": "", "coordinates, rows": ""}
    return table(lines, columns | dict.fromkeys((*COMPONENTS, "largest_of_moment"), ".2%"))


def peaks(radius: float) -> dict[str, float]:
    """Largest moments of bars of a radius, N m: what is "5 mm" in the paper, radius or diameter."""
    run = mbs.simulate(mbs.compile(scene.build(1, 2, 0, radius=radius)), scene.DURATION, STEP, progress=False)
    return {"diameter_mm": 2e3 * radius} | {c: float(np.max(np.abs(run[f"coupler.{c}"]))) for c in COMPONENTS}


def refusal() -> str:
    """What `compile` says to rigid bars."""
    try:
        mbs.compile(scene.build(flexible=False))
    except ModelError as error:
        return str(error)
    raise RuntimeError("The four-bar with rigid bars and a tilted axis was not recognised as locked.")


@wrong_on_purpose()
def draw(rows: Sequence[Row], file: Path) -> None:
    """The moments of the last of the bars over time as in the paper's Figure 5, the reference dashed; colours of Okabe
    and Ito.
    """
    last = [row for row in rows if row["table"] == "bars"][-1]
    bodies, expected = last["bodies_per_bar"], reference()
    _, run = measure((bodies, last["elements"], last["modes"] - 12), 0)
    plt = pyplot()
    figure, ax = plt.subplots(figsize=(8.0, 4.2), layout="constrained")
    for c, colour in zip(COMPONENTS, ("#0072B2", "#D55E00", "#009E73"), strict=True):
        ax.plot(run.t, run[f"coupler.{c}"], color=colour, linewidth=1.6, label=f"{c}, ALi3, {bodies} bodies per bar")
        ax.plot(expected["t"], expected[c], color="black", linewidth=1.0, dashes=(4, 4))
    ax.plot([], [], color="black", linewidth=1.0, dashes=(4, 4), label="geometrically exact beams (Exudyn)")
    ax.set_xlabel("time, s")
    ax.set_ylabel("moment in the middle of the coupler, N m")
    ax.grid(True, alpha=0.35)
    ax.legend(fontsize=8)
    save_chart(figure, file)
