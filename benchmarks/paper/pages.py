"""The paper's tables beside ours as text for the pages of `docs/`."""

from __future__ import annotations

from benchmarks.shared.pages import Row, table

SHORT = 3e-3  # s: a run that takes less is seldom interrupted, and its time is told


def four_bar_blocks(data: Row) -> dict[str, str]:
    """The paper's Table 1, without signs, beside the rows of N = 2, with theirs."""
    paper = {entry["h_s"]: entry for entry in data["meta"]["paper_table_1"]}
    lines = []
    for r in sorted((r for r in data["rows"] if r["N"] == 2 and r["method"] == "ALi3-P"), key=lambda r: -r["h_s"]):
        theirs = paper.get(r["h_s"], {})
        lines.append(
            {
                "h s": r["h_s"],
                "paper dE J": theirs.get("energy_deviation_J"),
                "ours dE J": r["energy_deviation_J"],
                "largest position error m": r["position_error_m"],
                "iterations, mean (most)": f"{r['iterations_mean']:.2f} ({r['iterations_max']})",
                "paper s (Matlab)": theirs.get("wall_s"),
                "ours ms": 1e3 * r["wall_s"] if r["wall_s"] < SHORT else None,
            }
        )
    return {"table 1": table(lines, dict.fromkeys(lines[0], ".3g"))}


def puma_blocks(data: Row) -> dict[str, str]:
    """The paper's Table 2 beside ours."""
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
    return {"table 2": table(data["rows"], columns)}
