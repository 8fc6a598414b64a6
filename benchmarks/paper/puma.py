"""The PUMA 560 whose hand is pinned and released: errors and energy jumps of a replay, and the errors of its stages."""

from collections.abc import Sequence
from typing import Any

import numpy as np

import mbs
from benchmarks.shared.pages import Row, table
from mbs.scenes import puma

PAPER = {0.01: 0.53, 0.05: 3.4}
"""Errors of the paper's Table 2, mm, by step, s; with 0.1 s its method did not converge."""
STEPS = (0.1, 0.05, 0.02, 0.01, 0.005)
METHODS = ("ali3p", "energy_momentum", "energy_momentum_4", "runge_kutta_8", "radau_5")
LARGE_STEP = 0.05  # s
SMALL_STEP = 0.0005  # s
STEPS_BY_STAGE = {
    "all stages": (LARGE_STEP, LARGE_STEP, LARGE_STEP),
    "stage 1, free": (LARGE_STEP, SMALL_STEP, SMALL_STEP),
    "stage 2, pinned": (SMALL_STEP, LARGE_STEP, SMALL_STEP),
    "stage 3, free": (SMALL_STEP, SMALL_STEP, LARGE_STEP),
    "none": (SMALL_STEP, SMALL_STEP, SMALL_STEP),
}
"""Steps of the three stages, s, by the stages with large ones."""


def measure(system: mbs.System, method: str, h: float) -> dict[str, Any]:
    """Row of a replay with a method and a step, s."""
    row: dict[str, Any] = {
        "method": method,
        "h_s": h,
        "error_mm": None,
        "path_error_mm": None,
        "jump_close_J": None,
        "jump_open_J": None,
        "paper_error_mm": PAPER.get(h),
        "ended": "finished",
    }
    settings = mbs.Settings(method=method)
    try:
        result = puma.replay(system, h, settings, estimate_error=False)
    except mbs.SimulationError as error:
        return row | {"ended": f"refused at {error.time:.3g} s: {error}"}
    return row | {
        "error_mm": 1e3 * result.error,
        "path_error_mm": 1e3 * result.path_error(),
        "jump_close_J": result.jumps_J[0],
        "jump_open_J": result.jumps_J[1],
    }


def errors_by_stage(system: mbs.System, method: str) -> list[dict[str, Any]]:
    """Rows of errors with large steps in one stage and small ones elsewhere, and of the hand's offset when pinned."""
    rows = []
    for title, steps in STEPS_BY_STAGE.items():
        result = puma.replay(system, steps, mbs.Settings(method=method), estimate_error=False)
        stage_1 = result.hand[result.times <= puma.STAGES_S[0]]
        offset = float(np.linalg.norm(stage_1[-1] - puma.pinned_position()))
        rows.append({"large steps in": title, "when pinned mm": 1e3 * offset, "error mm": 1e3 * result.error})
    return rows


def puma_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Our errors beside the paper's Table 2."""
    columns = {
        "method": "",
        "h_s": "g",
        "paper_error_mm": ".3g",
        "error_mm": ".3g",
        "path_error_mm": ".3g",
        "jump_close_J": ".1e",
        "jump_open_J": ".1e",
        "ended": "",
    }
    return {"table 2": table([row for row in rows if "method" in row], columns)}
