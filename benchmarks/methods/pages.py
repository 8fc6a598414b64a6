"""Measured tables of the methods as text for the pages of `docs/`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import mbs
from benchmarks.methods import random_honesty
from benchmarks.methods.error_control import CHOSEN, MOST_ERROR, MOST_TIME
from benchmarks.methods.honesty import FACTOR, HOLDS, SUMMARY, VERDICTS, summary
from benchmarks.methods.kernel_methods import TITLES
from benchmarks.methods.stability import OUTCOMES
from benchmarks.methods.stability_margins import SQUEEZED, USUAL_STEP
from benchmarks.methods.work_precision import LEVELS, compare, time_at_error
from benchmarks.references.cases import CASES
from benchmarks.shared.pages import Row, table


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
    return {
        "margins": margin_table(margins),
        "classical": table(classical, {"scene": "", "method": ""} | dict.fromkeys(OUTCOMES, "d") | {"first stop": ""}),
        "default": _default(margins),
        "why": table([{"method": k, "why": v} for k, v in why.items()], {"method": "", "why": ""}),
        "stability charts": "\n".join(
            f"![{CASES[s].title}](images/stability_{s}.png)\n"
            for s in dict.fromkeys(r["scene"] for f in files for r in f["rows"])
        ),
    }


def margin_table(margins: Sequence[Row]) -> str:
    """The distance of the default settings from failure, a line for each scene and method."""
    columns = {"scene": "", "method": "", "smallest_fine_h_s": ".1e", "largest_fine_h_s": ".1e", "first_break": ""}
    decades = dict.fromkeys(("decades_below", "decades_above"), ".0f") | {"usual_h_s": ".0e"}
    decades |= dict.fromkeys(("usual_below", "usual_above"), ".0f")
    return table(margins, columns | decades)


def _default(margins: Sequence[Row]) -> str:
    """What the margins say about the default method, in words."""
    name = TITLES[mbs.Settings().method]
    lines = [m for m in margins if m["method"] == name]
    usual = {m["scene"]: USUAL_STEP * SQUEEZED.get(m["scene"], 1.0) for m in lines}
    fine = [m for m in lines if (m["largest_fine_h_s"] or 0.0) > 0.999 * usual[m["scene"]]]

    def worst(key: str, unit: str) -> str:
        """The smallest value and its scenes."""
        least = min(m[key] for m in fine)
        scenes = [m["scene"] for m in fine if m[key] == least]
        return f"{least:.2g}{unit} ({'all of them' if len(scenes) == len(fine) else ', '.join(scenes)})"

    said = (
        f"{name}, the default: fine with its default settings from the smallest step tried up to {USUAL_STEP:g} s (a "
        f"hundredth of that for the squeezer) on {len(fine)} of {len(lines)} scenes."
    )
    if fine:
        said += (
            f" At that step the first eps that is not fine is {worst('usual_below', ' decades')} or more below the "
            f"default and {worst('usual_above', ' decades')} or more above; over all fine steps together "
            f"{worst('decades_below', '')} and {worst('decades_above', '')}."
        )
    reach = {m["scene"]: m["largest_fine_h_s"] for m in lines if m not in fine}
    small = [f"{scene} (up to {h:.2g} s)" for scene, h in reach.items() if h is not None]
    none = [scene for scene, h in reach.items() if h is None]
    said += f" Fine at smaller steps alone: {', '.join(small)}." if small else ""
    return said + (f" Not fine at any step: {', '.join(none)}." if none else "")


def dissipative_blocks(data: Row) -> dict[str, str]:
    """Flexible scenes and the car: a line for each scene and method."""
    lines = []
    for scene, method in dict.fromkeys((r["scene"], r["method"]) for r in data["rows"]):
        rows = [r for r in data["rows"] if (r["scene"], r["method"]) == (scene, method)]
        line = {"scene": scene, "method": method, "error": rows[0]["quantity"], "wrong from": f"{rows[0]['limit']:g}"}
        for r in sorted(rows, key=lambda r: -r["h_s"]):
            said = r["outcome"] if r["error"] is None else f"{r['outcome']}, {r['error']:.1e}"
            line["by step, s"] = "; ".join(filter(None, (line.get("by step, s"), f"{r['h_s']:g}: {said}")))
        line["first stop"] = next((r["reason"].partition(". Worst")[0] for r in rows if r["reason"]), "-")
        lines.append(line)
    return {"dissipative": table(lines, dict.fromkeys(lines[0], ""))}


def control_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """What the choice of method took at each tolerance, beside the best method by name."""
    lines = []
    for r in rows:
        if not r["method"].startswith(CHOSEN):
            continue
        others = [
            x
            for x in rows
            if (x["scene"], x["tolerance"]) == (r["scene"], r["tolerance"])
            and not x["method"].startswith(CHOSEN)
            and x["cpu_ms"]
            and x["error_over_tolerance"] <= MOST_ERROR
        ]
        best = min(others, key=lambda x: x["cpu_ms"], default=None)
        miss = [
            what for what, there in (("slow", (r["ratio"] or 0.0) > MOST_TIME), ("refused", not r["cpu_ms"])) if there
        ]
        if (r["error_over_tolerance"] or 0.0) > MOST_ERROR:
            miss.append("wrong" + (", warned" if r["warned"] else ""))
        lines.append(
            {**r, "chosen": r["method"].removeprefix(f"{CHOSEN}: "), "best": best and best["method"]}
            | {"best_ms": best and best["cpu_ms"], "miss": ", ".join(miss)}
        )
    columns = {"scene": "", "tolerance": ".0e", "chosen": "", "error_over_tolerance": ".2g", "cpu_ms": ".3g"}
    return {"control": table(lines, columns | {"best": "", "best_ms": ".3g", "ratio": ".2f", "miss": ""})}


def honesty_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Wrong runs caught and right ones disturbed, and by name those that went against the rule."""
    said = []
    for verdict in (VERDICTS[3], VERDICTS[1]):
        found = [r for r in rows if r["verdict"] == verdict]
        for method in dict.fromkeys(r["method"] for r in found):
            runs = (f"{r['scene']} at {r['h_s']:g} s ({r['error']:.2g})" for r in found if r["method"] == method)
            said.append(f"- {TITLES[method]}, {verdict.replace('wrong, ', '')}: {'; '.join(runs)}.")
    short = [
        f"{r['scene']} at {r['h_s']:g} s, {TITLES[r['method']]}: {r['error']:.1e}, estimate {r['estimate']:.1e}"
        for r in rows
        if r["estimate"] is not None and r["error"] > max(HOLDS, FACTOR * r["estimate"])
    ]
    said += [f"- More than {FACTOR:g} times the estimate: {'; '.join(short) or 'none'}."]
    return {
        "honesty": table(summary(list(rows)), SUMMARY),
        "honesty exceptions": "\n".join(said),
        "honesty crank": crank_table(rows),
    }


def machines_blocks(files: Sequence[Row]) -> dict[str, str]:
    """Verdicts on random machines of several seeds."""
    rows = [r for f in files for r in f["rows"]]
    columns = {k: f for k, f in random_honesty.SUMMARY.items() if not k.startswith("cost")}
    seeds = ", ".join(str(f["meta"]["seed"]) for f in files)
    none = sum(r["verdict"] == "none" for r in rows)
    said = f"Seeds {seeds}, {len({(f['meta']['seed'], r['number']) for f in files for r in f['rows']})} machines"
    return {
        "honesty machines": f"{said}; {none} without a reference.\n\n{table(random_honesty.summary(rows), columns)}"
    }


def crank_table(rows: Sequence[Row]) -> str:
    """The crank-slider of the modelling page with the default method, by step."""
    crank = [r for r in rows if r["scene"] == "printed_crank_slider" and r["method"] == "ali3p"]
    columns = {"h_s": "g", "ended": "", "error": ".1e", "estimate": ".1e", "balance": ".1e", "halvings_per_step": ".2g"}
    return table(crank, columns | {"verdict": ""})


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
    blocks = {"growth": table(data["rows"], columns) + f"\n\n{peak}.", "exponents": exponents}
    chassis = data["meta"].get("chassis")
    if chassis is None:
        return blocks
    columns = {
        "dynamic_modes": "d",
        "modes": "d",
        "coordinates": "d",
        "factor_nonzeros": "d",
        "system_bytes": "d",
        "iterations": ".2f",
        "us_per_step": ".0f",
        "us_per_iteration": ".0f",
    }
    slopes = ", ".join(f"{key.replace('_', ' ')} {value:.2f}" for key, value in chassis["exponents"].items())
    said = f"Steps of {chassis['step_s']:g} s. Exponents b of cost = a n^b in all modes n: {slopes}."
    return blocks | {"chassis growth": table(chassis["rows"], columns) + f"\n\n{said}"}
