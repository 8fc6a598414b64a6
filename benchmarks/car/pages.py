"""Tables of the car as text for the pages of `docs/`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from benchmarks.shared.pages import Row, table

TITLES = {
    "launch_and_brake": "launch and brake",
    "kerb_drop": "8 cm kerb at 5 m/s",
    "step_steer_given_throttle": "step steer",
    "slalom": "slalom",
    "steady_cornering": "steady cornering",
    "double_lane_change_replay": "double lane change",
    "full_lock": "full lock at 15 m/s",
    "drop": "drop from 0.5 m",
    "kerb_lock_brake": "8 cm kerb at 20 m/s, full lock and brake at once",
}
SMALLER = {"kerb_lock_brake": (0.002,)}
"""Steps beside those of 10 and 5 ms, s."""
HELD = ("the same through the FMU, inputs held",)
WITHOUT_INPUTS = ("kerb_drop", "drop")


def _errors(row: Row, way: str = "") -> str | None:
    path, load = row[f"path_error_rel{way}"], row[f"wheel_load_error_rel{way}"]
    return None if path is None else f"{path:.1e}, {100.0 * load:.2g} %"


def car_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Speed and accuracy by manoeuvre, and what held inputs cost."""
    order = list(TITLES)
    known = sorted((r for r in rows if r["manoeuvre"] in TITLES), key=lambda r: order.index(r["manoeuvre"]))
    lines: list[dict[str, Any]] = []
    for r in known:
        if r["h_s"] in (0.01, 0.005, *SMALLER.get(r["manoeuvre"], ())):
            lines.append(
                {
                    "manoeuvre": TITLES[r["manoeuvre"]],
                    "h, ms": f"{1e3 * r['h_s']:g}",
                    "path error, of its length; wheel-load error, of the peak": _errors(r),
                    HELD[0]: _errors(r, "_fmpy_held"),
                    "iterations, mean (most)": f"{r['iterations_mean']:.2f} ({r['iterations_max']})",
                }
            )
    held = [
        {
            "manoeuvre": TITLES[r["manoeuvre"]],
            "h, ms": f"{1e3 * r['h_s']:g}",
            "kernel: path, load": _errors(r),
            "FMU with derivatives": _errors(r, "_fmpy_followed"),
            "FMU, inputs held": _errors(r, "_fmpy_held"),
        }
        for r in known
        if r["h_s"] in (0.01, 0.002) and r["manoeuvre"] not in WITHOUT_INPUTS and _errors(r, "_fmpy_held")
    ]
    blocks = {"car": table(lines, dict.fromkeys(lines[0], ""))}
    return blocks | ({"held inputs": table(held, dict.fromkeys(held[0], ""))} if held else {})


def error_table(rows: Sequence[Row]) -> str:
    """Errors in the kernel by manoeuvre and step."""
    lines = [
        {
            "manoeuvre": r["manoeuvre"].replace("_", " "),
            "h, ms": f"{1e3 * r['h_s']:g}",
            "path error, of its length": f"{r['path_error_rel']:.1e}",
            "wheel-load error, of the peak": f"{100.0 * r['wheel_load_error_rel']:.2g} %",
        }
        for r in rows
    ]
    return table(lines, dict.fromkeys(lines[0], ""))


def function_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """In which functions the instructions of a scene are."""
    return {"functions": table(rows, {"function": "", "share": ".0%"})}


def instruction_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """What a step costs in iterations, factorizations and instructions."""
    lines = [r | {"step, ms": f"{r['step_ms']:g}"} for r in rows]
    columns = {"scene": "", "step, ms": "", "iterations": ".3f", "factorizations": ".3f", "solves": ".2f"}
    return {"instructions": table(lines, columns | {"instructions": ",d"})}
