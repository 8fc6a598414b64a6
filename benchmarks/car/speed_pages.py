"""Tables of many cars a core, of cars of other programs and of worst steps, as text for `docs/speed.md`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from benchmarks.shared.pages import Row, machine, table

THOUSAND = 1000
LANES = {
    "lanes tables": ("slalom, tables", "lane change, tables"),
    "lanes planar": ("double four-bar", "40 windows"),
    "lanes flexible": ("slalom, flexible frame", "kerb test, flexible frame", "flexible four-bar"),
}
"""Scenes by table, beside that of cars with links next to those of another commit."""
WAYS = {"single": "one after the other"}
CARS = {"slalom": "with links", "slalom, tables": "by tables"}
PEERS = {"links": "with links", "tables": "by tables"}
WILD, LIMITED_STEP = "wild", 2.0  # ms


def throughput_blocks(files: Sequence[Mapping[str, Any]]) -> dict[str, str]:
    """What lanes give, from runs of `benchmarks.throughput`: one beside an older commit, one of all scenes."""
    blocks: dict[str, str] = {}
    for file in files:
        rows = file["rows"]
        if "ratio_to_older" in rows[0]:
            blocks |= {"lanes": _ways(rows), "machine lanes": machine(file["meta"])}
            continue
        blocks["machine throughput"] = machine(file["meta"])
        for name, scenes in LANES.items():
            blocks[name] = _ways([row for scene in scenes for row in rows if row["scene"] == scene])
        blocks["lanes memory"] = _memory(rows)
        blocks["thousand cars"] = thousand(rows)
    return blocks


def _scene(row: Row) -> str:
    return f"{row['scene']}, {row['step_ms']:g} ms"


def _ways(rows: Sequence[Row]) -> str:
    """us a step and car by way and scene: (ratio to one after the other, ratio to an older commit)."""
    lines: dict[str, dict[str, str]] = {}
    for row in rows:
        ratios = [row[key] for key in ("ratio", "ratio_to_older") if key in row]
        if "ratio_to_older" in row and row["way"] == "single":
            older = row["us_a_step"] * row["ratio_to_older"]
            lines.setdefault("older", {"way": "one car of the older commit"})[_scene(row)] = f"{older:.1f}"
        line = lines.setdefault(row["way"], {"way": WAYS.get(row["way"], row["way"])})
        line[_scene(row)] = f"{row['us_a_step']:.1f} ({', '.join(f'{ratio:.2f}' for ratio in ratios)})"
    return table(list(lines.values()), dict.fromkeys(["way", *dict.fromkeys(map(_scene, rows))], ""))


def _groups(rows: Sequence[Row], scene: str) -> dict[str, Row]:
    """Rows of a scene by way, alone and in lanes on one core."""
    return {r["way"]: r for r in rows if r["scene"] == scene and (r["way"] == "single" or r["way"].endswith("lanes"))}


def _memory(rows: Sequence[Row]) -> str:
    lines = []
    for scene in dict.fromkeys(row["scene"] for row in rows):
        sizes = {f"{WAYS.get(way, way)}, kB": r["kilobytes_a_car"] for way, r in _groups(rows, scene).items()}
        lines.append({"scene": scene} | sizes)
    return table(lines, {key: "" if key == "scene" else ".0f" for key in lines[0]})


def thousand(rows: Sequence[Row]) -> str:
    """What a second of a thousand cars takes, computed from their steps."""
    lines = []
    there = {row["scene"] for row in rows}
    for scene, car in CARS.items():
        if scene not in there:
            continue
        ways = _groups(rows, scene)
        widest = list(ways)[-1]
        lanes = int(widest.split()[0])
        single, wide = (1e-3 * ways[way]["us_a_step"] / ways[way]["step_ms"] for way in ("single", widest))
        memory = [f"{1e-6 * THOUSAND * ways[way]['kilobytes_a_car']:.2g} GB" for way in ("single", widest)]
        lines.append(
            {
                "car": car,
                f"{THOUSAND} cores, a car each": f"{1e3 * single:.1f} ms",
                f"{-(-THOUSAND // lanes)} cores, {widest}": f"{1e3 * wide * lanes:.1f} ms",
                f"one core, {widest}": f"{THOUSAND * wide:.1f} s",
                f"memory: alone, in {widest}": ", ".join(memory),
            }
        )
    return table(lines, dict.fromkeys(lines[0], "")) if lines else ""


def peer_blocks(file: Mapping[str, Any]) -> dict[str, str]:
    """us of a core for a step by car, way and scene, from a run of `benchmarks.car_peers`."""
    lines: dict[tuple[str, str], dict[str, Any]] = {}
    for row in file["rows"]:
        line = lines.setdefault((row["car"], row["way"]), {"car": PEERS.get(row["car"], row["car"]), "way": row["way"]})
        line[_scene(row)] = row["us_a_step"]
    columns = {"car": "", "way": ""} | dict.fromkeys(map(_scene, file["rows"]), ".1f")
    return {"car peers": table(list(lines.values()), columns), "machine car peers": machine(file["meta"])}


def real_time_blocks(files: Sequence[Mapping[str, Any]]) -> dict[str, str]:
    """Worst steps of wild driving without a limit, and what limits leave at 2 ms, of `benchmarks.real_time`."""
    rows = [row for file in files for row in file["rows"] if row["drive"] == WILD]
    free = [
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
    blocks = {"machine real time": machine(files[0]["meta"])} if files else {}
    for name, lines in (("wild steps", free), ("wild limits", limited)):
        if lines:
            columns = {key: ".0f" if isinstance(value, float) else "" for key, value in lines[0].items()}
            blocks[name] = table(lines, columns)
    return blocks
