"""Tables of `docs/scale.md`: what was measured of studies, and what follows for a million runs on a thousand cores."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from benchmarks.shared.pages import table

Row = Mapping[str, Any]

RUNS, CORES = 1_000_000, 1000
_CHUNK_S, _AHEAD = 2.0, 2
"""Of `hosts.study`: work of a chunk in s, and chunks sent to a worker ahead."""
_FLUSH_S, _FLUSH_PART, _FLUSH_ROWS = (2.0, 60.0), 0.02, 50_000
"""Of `hosts.study`: s between parts, at least and at most; part of the time so far; rows of a part."""
_NETWORK = 1.25e9
"""Bytes per s of a network of 10 Gbit/s."""
_FMU, _SIGNALS = 2.2e6, 20 * 100 * 8
"""Bytes of the FMU of the prototype car, and of 20 signals kept at 100 instants."""


def study_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Tables by name, of those that were measured."""
    made: dict[str, str] = {}
    runs = [r for r in rows if r["table"] == "runs"]
    car, spring = ([_shown(r) for r in runs if r["case"] == case] for case in ("car", "spring"))
    if car:
        columns = {"workers": "d", "runs": ",d", "run, s": ".4f", "runs/s": ".2f", "chunks": ",d"}
        columns |= {"overhead, ms/run": ".2f", "overhead": ".2%", "bytes/run": ".0f", "parts": "d", "failed": "d"}
        loop = next((r for r in rows if r["table"] == "loop"), None)
        alone = f"\n\nThe same runs in a plain loop without Dask take {loop['run_s']:.4f} s each." if loop else ""
        made["study overhead"] = table(car, columns) + alone
    if spring:
        columns = {"runs": ",d", "main before, MB": ".0f", "main at most, MB": ".0f", "main, ms/run": ".3f"}
        columns |= {"worker, MB": ".0f", "bytes/run": ".0f", "parts": "d", "start again, s": ".1f"}
        again = {r["runs"]: r["start_s"] for r in rows if r["table"] == "start again"}
        made["study memory"] = table([r | {"start again, s": again.get(r["runs"])} for r in spring], columns)
    single = _single(rows)
    if single:
        made["study single"] = table(
            single, {"what": "", "number": ",d", "ms each": ".4f", "in all, s": ".2f", "MB": ".0f"}
        )
    if car and spring and single:
        made["study scale"] = table(_extrapolated(rows), {"what": "", "arithmetic": "", "result": ""})
    return made


def _shown(row: Row) -> dict[str, Any]:
    names = {
        "workers": "workers", "runs": "runs", "run_s": "run, s", "rate": "runs/s", "chunks": "chunks", "parts": "parts",
        "overhead_ms": "overhead, ms/run", "overhead": "overhead", "bytes": "bytes/run", "failed": "failed",
        "before_mb": "main before, MB", "main_mb": "main at most, MB", "main_ms": "main, ms/run",
        "worker_mb": "worker, MB",
    }  # fmt: skip
    return {name: row[key] for key, name in names.items()}


def _single(rows: Sequence[Row]) -> list[dict[str, Any]]:
    found = []
    for r in rows:
        if r["table"] == "plan":
            line = {"what": f"plan, {r['method'].replace('_', ' ')}", "number": r["runs"], "ms each": r["main_ms"]}
            found.append(line | {"in all, s": r["start_s"], "MB": r["main_mb"]})
        elif r["table"] == "rows":
            number, written = r["runs"], 1e-3 * r["main_ms"] * r["runs"]
            found.append({"what": "rows written", "number": number, "ms each": r["main_ms"], "in all, s": written})
            seconds = r["found_s"]
            found.append(
                {"what": "rows found", "number": number, "ms each": 1e3 * seconds / number, "in all, s": seconds}
            )
            line = {"what": "rows opened by pandas", "number": number, "ms each": 1e3 * r["read_s"] / number}
            found.append(line | {"in all, s": r["read_s"], "MB": r["read_mb"]})
        elif r["table"] == "empty tasks":
            line = {"what": "empty tasks, client and scheduler", "number": r["runs"], "ms each": r["main_ms"]}
            found.append(line | {"in all, s": r["elapsed_s"]})
    return found


def parts_of(seconds: float, rate: float) -> int:
    """Parts that a study writes in so many seconds at a rate in rows per s."""
    count, time = 0, 0.0
    while time < seconds:
        wait = min(max(_FLUSH_S[0], _FLUSH_PART * time), _FLUSH_S[1])
        time += min(wait, _FLUSH_ROWS / rate)
        count += 1
    return count


def _extrapolated(rows: Sequence[Row]) -> list[dict[str, str]]:
    """The arithmetic, with what was measured in it."""
    springs = sorted((r for r in rows if r["table"] == "runs" and r["case"] == "spring"), key=lambda r: r["runs"])
    car = max((r for r in rows if r["table"] == "runs" and r["case"] == "car"), key=lambda r: r["workers"])
    written = next(r for r in rows if r["table"] == "rows")
    task = next(r for r in rows if r["table"] == "empty tasks")["main_ms"]
    plan = max((r for r in rows if r["table"] == "plan"), key=lambda r: r["main_mb"])
    run, seconds = 0.1, 0.1 * RUNS / CORES
    rate, size = CORES / run, round(_CHUNK_S / run)
    tasks = rate / size
    slope = _slope(springs)
    row_ms, row_bytes = written["main_ms"], written["bytes"]
    memory = springs[-1]["before_mb"] + 1e-6 * slope * RUNS + plan["main_mb"] * RUNS / plan["runs"]

    of_plan, before = 1e6 * plan["main_mb"] / plan["runs"], springs[-1]["before_mb"]
    found = written["found_s"] * RUNS / written["runs"]
    slow = 10.0  # s of a run that is a whole manoeuvre at a high fidelity
    lines = [
        (
            "time",
            f"{RUNS:,} × {run} s / {CORES:,}, and {car['overhead']:.1%}",
            f"{seconds * (1 + car['overhead']):.0f} s",
        ),
        ("rows from the workers", f"{CORES:,} / {run} s", f"{rate:,.0f} per s"),
        ("tasks", f"{rate:,.0f} per s / {size} runs of a chunk", f"{tasks:,.0f} per s, {RUNS // size:,} in all"),
        (
            "scheduler and client for tasks",
            f"{tasks:,.0f} per s × {task:.2f} ms",
            f"{1e-3 * tasks * task:.0%} of a core",
        ),
        ("writer", f"{rate:,.0f} per s × {row_ms:.4f} ms", f"{1e-3 * rate * row_ms:.0%} of a core"),
        ("workers that fill the writer", f"{run} s / {row_ms:.4f} ms", f"{1e3 / row_ms * run:,.0f}"),
        ("workers that fill the scheduler", f"{_CHUNK_S:g} s / {task:.2f} ms", f"{1e3 / task * _CHUNK_S:,.0f}"),
        ("chunks sent ahead", f"{_AHEAD} × {CORES:,}", f"{_AHEAD * CORES:,}"),
        (
            "memory of the main process",
            f"{before:.0f} MB + {RUNS:,} × ({slope:.0f} B + {of_plan:.0f} B of the plan)",
            f"{memory:.0f} MB",
        ),
        ("results on the disk", f"{RUNS:,} × {row_bytes:.0f} B", f"{1e-6 * RUNS * row_bytes:.0f} MB"),
        ("files of results", f"{seconds:.0f} s, a part every 2 to 60 s", f"{parts_of(seconds, rate)}"),
        (
            f"the same for runs of {slow:g} s",
            f"{slow * RUNS / CORES:,.0f} s, a part every 2 to 60 s",
            f"{parts_of(slow * RUNS / CORES, CORES / slow)}",
        ),
        (
            "FMU to the workers",
            f"{CORES:,} × {1e-6 * _FMU:.1f} MB over 10 Gbit/s",
            f"{CORES * _FMU / _NETWORK:.1f} s",
        ),
        (
            "20 signals kept at 100 instants",
            f"{rate:,.0f} per s × {1e-3 * _SIGNALS:.0f} kB",
            f"{1e-6 * rate * _SIGNALS:.0f} MB/s to one process, {1e-9 * RUNS * _SIGNALS:.0f} GB in all",
        ),
        ("start again: rows found", f"{RUNS:,} / {written['runs']:,} × {written['found_s']:.2f} s", f"{found:.1f} s"),
    ]
    return [dict(zip(("what", "arithmetic", "result"), line, strict=True)) for line in lines]


def _slope(springs: Sequence[Row]) -> float:
    """Bytes that the main process grows by with a run, between the two largest studies; not below zero."""
    if len(springs) < 2:
        return math.nan
    small, large = springs[-2:]
    return max(0.0, 1e6 * (large["main_mb"] - small["main_mb"]) / (large["runs"] - small["runs"]))
