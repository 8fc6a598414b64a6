"""Worst steps of wild driving: the prototype at random over kerbs across a rough half and ramps on a smooth one.

At each fidelity and step it is driven once without a limit of the iterations of a step and once with `LIMITS`. Measured
is processor time of the thread, which leaves out what others do in between.
"""

import tempfile
import warnings
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import fmpy
import numpy as np

import mbs
from ali3.errors import UserError
from benchmarks.car.step_costs import drive, summary
from benchmarks.shared.pages import Row, table
from fmu_src.build.build import build_fmu
from fmu_src.build.scene_registry import load_fidelities
from hosts.driving.random_driver import Target
from mbs.common.progress import progress_for
from mbs.elements.road import GridRoad

LIMITED_STEP = 2.0  # ms
FIDELITIES = (0, 1, 2, 3)
STEPS = (1.0, 2.0, 5.0, 10.0)
LIMITS = {0: (6, 8, 12, 12), 1: (4, 6, 12, 12), 2: (3, 3, 8, 12), 3: (3, 3, 8, 12)}
"""Limits of the iterations of a step by fidelity, for each of `STEPS`: what a quarter of the deadline has time for."""
EDGE = 150.0  # half the side of the square, m
SPACING = 0.25  # between points, m
KERB = 0.08  # m
KERB_LENGTH = 2.0  # m
KERB_DISTANCE = 15.0  # m
ROUGHNESS = 0.01  # m, standard deviation before smoothing
RAMPS = ((25.0, -75.0, 0.3), (25.0, 0.0, 0.5), (25.0, 75.0, 0.7), (75.0, -37.5, 1.0), (75.0, 37.5, 1.0))
"""Place of the lower edge and height at the upper one, m; they rise along x."""
RAMP_LENGTH = 8.0
RAMP_WIDTH = 6.0
FRICTION = 0.9


def measure(options: Namespace) -> list[dict[str, Any]]:
    """Rows of all drives."""
    fidelities, steps, only = options.fidelity, options.step, [int(limit) for limit in options.limit]
    if not (set(fidelities) <= set(FIDELITIES) and set(steps) <= set(STEPS)):
        raise UserError(f"Fidelities are of {FIDELITIES} and steps of {STEPS} ms; given: {fidelities} and {steps}.")
    limits = {(f, h): only or [0, LIMITS[f][STEPS.index(h)]] for f in fidelities for h in steps}
    cases = [(fidelity, step, limit) for (fidelity, step), chosen in limits.items() for limit in chosen]
    rows = []
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder, progress_for(None) as bar:
        road = Path(folder, "wild.road")
        targets = write_ground(road)
        car = options.fmu or _built(Path(folder))
        for k, (fidelity, ms, limit) in enumerate(cases):
            start = {"fidelity": fidelity, "solver.step_iterations": limit, "road.file": str(road.resolve())}
            costs = drive(
                *(car, start, options.seconds, targets, 1e-3 * ms, options.seed),
                lambda share, k=k: bar.update((k + share) / len(cases)),
            )
            row: dict[str, Any] = {"fidelity": fidelity, "step_ms": ms, "limit": limit}
            rows.append(row | summary(costs, 1e-3 * ms))
    return rows


def _built(folder: Path) -> Path:
    name, systems, default = load_fidelities("prototype_car")
    return build_fmu(list(systems.values()), name, folder, [fmpy.platform], kind="native", fidelity=default)


def write_ground(file: Path) -> list[Target]:
    """Write the road file; the same bytes each time."""
    n = round(2.0 * EDGE / SPACING)
    x = SPACING * np.arange(n) - EDGE
    rough = np.random.Generator(np.random.PCG64(3)).normal(0.0, ROUGHNESS, (n, n))
    rough = 0.5 * (rough + np.roll(rough, 1, 0) + np.roll(rough, 1, 1) + np.roll(rough, -1, 0))
    heights = np.where(x[:, None] < 0.0, rough, 0.0)
    heights[(x < 0.0) & ((x + EDGE) % KERB_DISTANCE < KERB_LENGTH)] += KERB
    for x0, y0, top in RAMPS:
        along, across = (x >= x0) & (x < x0 + RAMP_LENGTH), np.abs(x - y0) < 0.5 * RAMP_WIDTH
        heights[np.ix_(along, across)] = top * ((x[along] - x0) / RAMP_LENGTH)[:, None]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", mbs.roads.RoadWarning)  # ramps end in a drop; rough driving is what it is for
        mbs.write_road(GridRoad((-EDGE, -EDGE), (SPACING, SPACING), heights, FRICTION), file)
    return [Target(x0, y0, 0.0) for x0, y0, _ in RAMPS]


def real_time_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Worst steps of wild driving without a limit, and what limits leave at 2 ms."""
    unlimited = [
        {
            "fidelity": r["fidelity"],
            "step, ms": f"{r['step_ms']:g}",
            "iterations, mean and most": f"{r['iterations']:.2f}, {r['most_iterations']}",
            "mean, us": r["mean_us"],
            "p99.9, us": r["p99_9_us"],
            "worst, us": r["worst_us"],
            "quarter of the deadline, us": r["quarter_us"],
        }
        for r in rows
        if r["limit"] == 0
    ]
    limited = [
        {
            "fidelity": r["fidelity"],
            "limit": r["limit"],
            "capped steps": f"{r['capped']} of {r['steps']}",
            "left at most, mm": f"{r['residual_mm']:.2g}",
        }
        for r in rows
        if r["limit"] > 0 and r["step_ms"] == LIMITED_STEP
    ]
    blocks = {}
    for name, lines in (("wild steps", unlimited), ("wild limits", limited)):
        if lines:
            columns = {key: ".0f" if isinstance(value, float) else "" for key, value in lines[0].items()}
            blocks[name] = table(lines, columns)
    return blocks
