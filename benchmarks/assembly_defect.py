"""Four-bar with assembly defect: ``python -m benchmarks.assembly_defect [--json FILE] [--chart FILE] [--quick]``.

Section forces in the middle of the coupler (paper, section 3.3, Figure 5) against an independent program with
geometrically exact beams, for bars of 1, 2, 4 and 8 flexible bodies and several sets of modes.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import mbs
from benchmarks.command import parser_of, pyplot, save_chart, save_rows, watched
from benchmarks.common import describe, median_wall, print_table, wrong_on_purpose
from mbs.errors import ModelError
from mbs.scenes import assembly_defect_four_bar as scene

REFERENCE = Path(__file__).with_name("assembly_defect_reference.csv")
ORIGIN = "Exudyn 1.13.6, ObjectBeamGeometricallyExact, 16 elements per 0.12 m, h = 2.5 ms (benchmarks/exudyn_beams.py)"
COMPONENTS = ("T", "My", "Mz")
STEP = 0.01  # s, as the reference is stored
GOAL = 0.03  # of the peak
# bodies per bar, elements per body, dynamic modes per body
CASES = ((1, 2, 0), (1, 4, 2), (1, 8, 6), (2, 2, 0), (2, 4, 2), (4, 2, 0), (4, 4, 2), (8, 2, 0))
FEW = CASES[:1]
TABLE = {
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
}


def reference() -> dict[str, NDArray[np.float64]]:
    """Time, s, and the three moments, N m, each shape (n,)."""
    data = np.loadtxt(REFERENCE, delimiter=",", skiprows=2)
    return dict(zip(("t", *COMPONENTS), data.T, strict=True))


def measure(
    case: tuple[int, int, int], expected: dict[str, NDArray[np.float64]], repeats: int
) -> tuple[dict[str, Any], mbs.Trajectory]:
    """One row, and the run it comes from."""
    parts, elements, dynamic = case
    system = mbs.compile(scene.build(parts, elements, dynamic))
    run = mbs.simulate(system, scene.DURATION, STEP, progress=False)
    wall = median_wall(
        lambda: mbs.simulate(system, scene.DURATION, STEP, every=1000, progress=False).wall_s, repeats, warm_up=0
    )
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


def refusal() -> str:
    """What `compile` says to rigid bars."""
    try:
        mbs.compile(scene.build(flexible=False))
    except ModelError as error:
        return str(error)
    raise RuntimeError("The four-bar with rigid bars and a tilted axis was not recognised as locked.")


def draw(run: mbs.Trajectory, expected: dict[str, NDArray[np.float64]], bodies: int, file: Path) -> None:
    """The three moments over time as in the paper's Figure 5, the reference dashed; colours of Okabe and Ito."""
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


@wrong_on_purpose()
def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("assembly_defect", __doc__, chart="the moments over time")
    parser.add_argument("--quick", action="store_true", help="one flexible body per bar only")
    options = parser.parse_args(arguments)
    expected = reference()
    rows: list[dict[str, Any]] = []
    for case in watched(FEW if options.quick else CASES):
        row, run = measure(case, expected, 1 if options.quick else 3)
        rows.append(row)
    meta = describe("four-bar with assembly defect", mbs.Settings(), end_s=scene.DURATION, h_s=STEP, reference=ORIGIN)
    print(f"{meta['machine']['processor']}, {meta['machine']['cores']} cores, {meta['machine']['system']}\n")
    print(f"Against {ORIGIN};")
    print("largest difference as a fraction of the peak of each moment, and of the largest of all moments\n")
    print_table(rows, TABLE)
    print(f"\nWith rigid bars: {refusal()}")
    save_rows(options.json, meta, rows)
    if options.chart is not None:
        draw(run, expected, rows[-1]["bodies_per_bar"], options.chart)
    return 0


if __name__ == "__main__":
    sys.exit(main())
