"""The paper's tables beside ours as text for the pages of `docs/`."""

from __future__ import annotations

from benchmarks.shared.pages import Row, table


def four_bar_blocks(data: Row) -> dict[str, str]:
    """The paper's Table 1 beside the rows of N = 2."""
    found = {(r["method"], r["h_s"]): r for r in data["rows"] if r["N"] == 2}
    lines = []
    for entry in data["meta"]["paper_table_1"]:
        ours = found["ALi3-P", entry["h_s"]]
        lines.append(
            {
                "h s": entry["h_s"],
                "paper dE J": entry["energy_deviation_J"],
                "ours dE J": ours["energy_deviation_J"],
                "paper s (Matlab)": entry["wall_s"],
                "ours s": ours["wall_s"],
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
        "paper_wall_s": ".3g",
        "wall_s": ".2g",
        "jump_close_J": ".1e",
        "jump_open_J": ".1e",
        "ended": "",
    }
    return {"table 2": table(data["rows"], columns)}
