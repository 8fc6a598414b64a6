"""The PUMA 560 whose hand is pinned and released: ``python -m benchmarks.puma [--json FILE] [--quick] [--split]``.

The paper's Table 2 beside ours: distance between the first and the last position of the hand, after eight seconds.
With `--split` also where that error comes from: large steps in one stage only.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from typing import Any

import numpy as np

import mbs
from benchmarks.command import parser_of, save_rows, watched
from benchmarks.common import describe, median_wall, print_table
from mbs.scenes import puma

PAPER = {0.01: (0.53e-3, 6.25), 0.05: (3.4e-3, 1.92), 0.1: (None, None)}  # s: (m, s), Table 2; 0.1: no convergence
STEPS = (0.1, 0.05, 0.02, 0.01, 0.005)
METHODS = ("ali3p", "energy_momentum", "energy_momentum_4", "runge_kutta_8", "radau_5")
ROUNDS = 5
LARGE, SMALL = 0.05, 0.0005  # s
SPLIT = {
    "all stages": (LARGE, LARGE, LARGE),
    "stage 1, free": (LARGE, SMALL, SMALL),
    "stage 2, pinned": (SMALL, LARGE, SMALL),
    "stage 3, free": (SMALL, SMALL, LARGE),
    "none": (SMALL, SMALL, SMALL),
}
TABLE = {
    "method": "",
    "h_s": "g",
    "error_mm": ".3g",
    "path_error_mm": ".3g",
    "jump_close_J": ".2e",
    "jump_open_J": ".2e",
    "wall_s": ".2e",
    "paper_error_mm": ".3g",
    "paper_wall_s": ".3g",
    "ended": "",
}


def measure(system: mbs.System, method: str, h: float, rounds: int) -> dict[str, Any]:
    """One row; the wall time is that of the whole replay, with what Python does around the steps."""
    paper, paper_wall = PAPER.get(h, (None, None))
    row: dict[str, Any] = {
        "method": method,
        "h_s": h,
        "error_mm": None,
        "path_error_mm": None,
        "jump_close_J": None,
        "jump_open_J": None,
        "wall_s": None,
        "paper_error_mm": None if paper is None else 1e3 * paper,
        "paper_wall_s": paper_wall,
        "ended": "finished",
    }
    settings = mbs.Settings(method=method)
    try:
        found = puma.replay(system, h, settings)
    except mbs.SimulationError as error:
        return row | {"ended": f"refused at {error.time:.3g} s: {error}"}

    def act() -> float:
        begin = time.perf_counter()
        puma.replay(system, h, settings)
        return time.perf_counter() - begin

    return row | {
        "error_mm": 1e3 * found.error,
        "path_error_mm": 1e3 * found.path_error(),
        "jump_close_J": found.jumps_J[0],
        "jump_open_J": found.jumps_J[1],
        "wall_s": median_wall(act, rounds, 0),
    }


def split(system: mbs.System, method: str) -> list[dict[str, Any]]:
    """Error with large steps in one stage and small ones elsewhere, and where the hand was when the pin closed."""
    rows = []
    for title, steps in SPLIT.items():
        found = puma.replay(system, steps, mbs.Settings(method=method))
        held = found.hand[found.times <= puma.STAGES_S[0]]
        offset = float(np.linalg.norm(held[-1] - puma.held_at()))
        rows.append({"large steps in": title, "when pinned mm": 1e3 * offset, "error mm": 1e3 * found.error})
    return rows


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("puma", __doc__)
    parser.add_argument("--quick", action="store_true", help="one method, one round")
    parser.add_argument("--split", action="store_true", help=f"also the share of each stage at h = {LARGE} s")
    options = parser.parse_args(arguments)
    system = mbs.compile(puma.build())
    rows = [
        measure(system, method, h, 1 if options.quick else ROUNDS)
        for method, h in watched([(m, h) for m in (METHODS[:1] if options.quick else METHODS) for h in STEPS])
    ]
    print_table(rows, TABLE)
    if options.split:
        print(f"\n{METHODS[0]}, steps of {LARGE} s in one stage and {SMALL} s elsewhere")
        print_table(split(system, METHODS[0]), {"large steps in": "", "when pinned mm": ".3g", "error mm": ".3g"})
    save_rows(options.json, describe("puma", mbs.Settings(), rounds=ROUNDS), rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
