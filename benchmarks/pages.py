"""Write measured tables into the pages of `docs/`: ``python -m benchmarks.pages --work FILE --stability FILE ...``.

A table stands between ``<!-- begin NAME -->`` and ``<!-- end NAME -->``; the text around it is written by hand.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from benchmarks.cases import CASES
from benchmarks.stability import OUTCOMES
from benchmarks.work_precision import LEVELS, compare, time_at_error

DOCS = Path(__file__).resolve().parents[1] / "docs"
PAGES = ("speed_and_accuracy.md", "stability.md")
Row = Mapping[str, Any]


def table(rows: Sequence[Row], columns: Mapping[str, str]) -> str:
    """A Markdown table; `columns` maps the keys to formats, None prints as "–"."""

    def cell(value: Any, form: str) -> str:
        if value is None:
            return "–"
        return str(value).replace("|", "\\|") if isinstance(value, str) else format(value, form)

    head = [key.replace("_", " ") for key in columns]
    lines = [head, ["---"] * len(head)] + [[cell(r.get(k), f) for k, f in columns.items()] for r in rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def machine(meta: Row) -> str:
    """Where and when, one line."""
    m = meta["machine"]
    versions = ", ".join(f"{k} {v}" for k, v in m["versions"].items())
    return (
        f"{m['processor']}, {m['cores']} cores, {m['system']}, Python {m['python']}; {versions}; {meta['time'][:10]}."
    )


def work_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """The comparison with the peers, and the time each method takes to each error."""
    scenes = list(dict.fromkeys(r["scene"] for r in rows))
    ratios = [line for s in scenes for line in compare(list(rows), s) if line["peer_ms"] is not None]
    columns = {
        "scene": "",
        "error_m": ".0e",
        "ours": "",
        "ours_ms": ".3g",
        "peer": "",
        "peer_ms": ".3g",
        "ratio": ".2g",
    }
    behind = [r for r in ratios if r["ahead"] == "NO"]
    half = [r for r in ratios if r["ratio"] is not None and 0.5 < r["ratio"] <= 1.0]
    said = f"Behind the best peer in {len(behind)} of {len(ratios)} lines"
    said += ": " + "; ".join(f"{r['scene']} at {r['error_m']:.0e} m" for r in behind) + "." if behind else "."
    said += f" Ahead, but by less than a factor of two, in {len(half)}."
    times = []
    for scene in scenes:
        part = [r for r in rows if r["scene"] == scene]
        for method in dict.fromkeys(r["method"] for r in part):
            line: dict[str, Any] = {"scene": scene, "method": method}
            line |= {f"{level:.0e} m": _ms(time_at_error(part, method, level)) for level in LEVELS}
            runs = [r for r in part if r["method"] == method]
            line["finished"] = f"{sum(r['ended'] == 'finished' for r in runs)} of {len(runs)}"
            times.append(line)
    columns_2 = {"scene": "", "method": ""} | {f"{level:.0e} m": ".3g" for level in LEVELS} | {"finished": ""}
    charts = "\n".join(f"![{CASES[s].title}](images/work_{s}.png)\n" for s in scenes)
    ratio_table = table(ratios, columns | {"ahead": ""}) + "\n\n" + said
    return {"ratios": ratio_table, "times": table(times, columns_2), "work charts": charts}


def _ms(wall: float | None) -> float | None:
    return None if wall is None else 1e3 * wall


def stability_blocks(files: Sequence[Row]) -> dict[str, str]:
    """Margins of the default settings, and what became of the classical methods."""
    margins = [line for f in files for line in f["meta"]["margins"]]
    classical = [line for f in files for line in f["meta"]["classical"]]
    why = files[0]["meta"]["why"]
    columns = {"scene": "", "method": "", "smallest_fine_h_s": ".1e", "largest_fine_h_s": ".1e", "first_break": ""}
    decades = dict.fromkeys(("decades_below", "decades_above"), ".0f") | {"usual_h_s": ".0e"}
    decades |= dict.fromkeys(("usual_below", "usual_above"), ".0f")
    return {
        "margins": table(margins, columns | decades),
        "classical": table(classical, {"scene": "", "method": ""} | dict.fromkeys(OUTCOMES, "d") | {"first stop": ""}),
        "why": table([{"method": k, "why": v} for k, v in why.items()], {"method": "", "why": ""}),
        "stability charts": "\n".join(
            f"![{CASES[s].title}](images/stability_{s}.png)\n"
            for s in dict.fromkeys(r["scene"] for f in files for r in f["rows"])
        ),
    }


def growth_blocks(data: Row) -> dict[str, str]:
    """Growth and the distance to what the machine could do."""
    columns = {
        "N": "d",
        "method": "",
        "us_per_step": ".3g",
        "iterations": ".2f",
        "factor_nonzeros": "d",
        "system_bytes": "d",
        "operations_per_step": ".0f",
        "gflops": ".2f",
        "of_compiled_loop": ".0%",
        "of_dgemm": ".1%",
    }
    fitted = data["meta"]["exponents"]
    first = data["rows"][0]
    peak = f"NumPy's matrix product reaches {first['dgemm_gflops']:.1f} Gflop/s in one thread here"
    if first.get("compiled_loop_gflops"):
        peak += f", a loop of multiply-adds with the kernel's compiler and flags {first['compiled_loop_gflops']:.1f}"
    exponents = table(fitted, {"method": ""} | {k: ".2f" for k in fitted[0] if k != "method"}) if fitted else ""
    return {"growth": table(data["rows"], columns) + f"\n\n{peak}.", "exponents": exponents}


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


def replace(text: str, blocks: Mapping[str, str]) -> str:
    """The page with its tables exchanged; what was not measured stays."""
    for name, content in blocks.items():
        mark = re.compile(rf"(<!-- begin {re.escape(name)} -->\n).*?(<!-- end {re.escape(name)} -->)", re.DOTALL)
        text = mark.sub(lambda m, content=content: f"{m[1]}{content.strip()}\n{m[2]}", text)
    return text


def _read(files: Sequence[Path]) -> list[dict[str, Any]]:
    return [json.loads(f.read_text(encoding="utf-8")) for f in files]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.pages", description=__doc__)
    for name in ("work", "stability", "growth", "four-bar", "puma"):
        parser.add_argument(f"--{name}", type=Path, nargs="+", default=[], metavar="FILE", help=f"JSON of {name}")
    parser.add_argument("--docs", type=Path, default=DOCS, help="folder of the pages")
    o = parser.parse_args(arguments)
    files = (o.work, o.stability, o.growth, o.four_bar, o.puma)
    work, stability, growth, four_bar, puma = (_read(f) for f in files)
    blocks: dict[str, str] = {}
    if work:
        blocks |= work_blocks([r for f in work for r in f["rows"]]) | {"machine work": machine(work[0]["meta"])}
    if stability:
        blocks |= stability_blocks(stability) | {"machine stability": machine(stability[0]["meta"])}
    if growth:
        blocks |= growth_blocks(growth[0]) | {"machine growth": machine(growth[0]["meta"])}
    if four_bar:
        blocks |= four_bar_blocks(four_bar[0])
    if puma:
        blocks |= puma_blocks(puma[0])
    for page in PAGES:
        file = o.docs / page
        file.write_text(replace(file.read_text(encoding="utf-8"), blocks), encoding="utf-8")
    print(f"{len(blocks)} tables written")
    return 0


if __name__ == "__main__":
    sys.exit(main())
