"""The PUMA 560 whose hand is pinned and released: errors, energy jumps, error by stage."""

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
LARGE = 0.05  # s
SMALL = 0.0005  # s
SPLIT = {
    "all stages": (LARGE, LARGE, LARGE),
    "stage 1, free": (LARGE, SMALL, SMALL),
    "stage 2, pinned": (SMALL, LARGE, SMALL),
    "stage 3, free": (SMALL, SMALL, LARGE),
    "none": (SMALL, SMALL, SMALL),
}


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


def split(system: mbs.System, method: str) -> list[dict[str, Any]]:
    """Rows of errors with large steps in one stage and small ones elsewhere, and of the hand's offset when pinned."""
    rows = []
    for title, steps in SPLIT.items():
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
