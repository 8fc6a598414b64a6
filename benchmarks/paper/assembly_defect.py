"""The four-bar with assembly defect against geometrically exact beams: differences, largest moments, chart."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

import mbs
from benchmarks.references.assembly_defect import COMPONENTS, reference
from benchmarks.shared.coarse_runs import expected_errors
from benchmarks.shared.command import pyplot, save_chart
from benchmarks.shared.pages import Row, table
from mbs.scenes import assembly_defect_four_bar as scene

STEP = 0.01  # s, interval of the stored reference
CASES = ((1, 2, 0), (1, 8, 6), (2, 2, 0), (4, 2, 0), (8, 2, 0))
"""Bodies per bar, elements and dynamic modes of each body."""
RADII = (scene.RADIUS, 0.5 * scene.RADIUS)  # m


def simulate(system: mbs.System) -> mbs.Trajectory:
    """Simulate a four-bar at the instants of the stored reference."""
    return mbs.simulate(system, scene.DURATION, STEP, progress=False)


def measure(case: tuple[int, int, int]) -> dict[str, Any]:
    """Row of a case: its size and the largest differences of the moments, of the largest moment."""
    parts, elements, dynamic = case
    system, expected = mbs.compile(scene.build(*case)), reference()
    run = simulate(system)
    gaps = {c: float(np.max(np.abs(run[f"coupler.{c}"] - expected[c]))) for c in COMPONENTS}
    largest = {c: float(np.max(np.abs(expected[c]))) for c in COMPONENTS}
    return {
        "bodies_per_bar": parts,
        "elements, modes of each": f"{elements}, {12 + dynamic}",
        "coordinates, rows": f"{system.nq}, {system.nc}",
        **{c: gaps[c] / largest[c] for c in COMPONENTS},
        "largest_of_moment": max(gaps.values()) / max(largest.values()),
    }


def defect_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Table of sizes and errors by bodies, elements and modes."""
    columns = {"bodies_per_bar": "d", "elements, modes of each": "", "coordinates, rows": ""}
    columns |= dict.fromkeys((*COMPONENTS, "largest_of_moment"), ".2%")
    return {"defect": table([row for row in rows if row["table"] == "bars"], columns)}


def peaks(radius: float) -> dict[str, float]:
    """Largest moments of bars of a radius, N m: the paper's "5 mm" may be radius or diameter."""
    run = simulate(mbs.compile(scene.build(1, 2, 0, radius=radius)))
    return {"diameter_mm": 2e3 * radius} | {c: float(np.max(np.abs(run[f"coupler.{c}"]))) for c in COMPONENTS}


@expected_errors()
def draw(rows: Sequence[Row], file: Path) -> None:
    """Draw the moments of the last row over time as in the paper's Figure 5, the reference dashed; colours of Okabe and
    Ito.
    """
    bodies, expected = [row for row in rows if row["table"] == "bars"][-1]["bodies_per_bar"], reference()
    run = simulate(mbs.compile(scene.build(*next(case for case in CASES if case[0] == bodies))))
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
