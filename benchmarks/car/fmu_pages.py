"""Times of FMUs, of their WebAssembly and of cars in Python as text for the pages."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from benchmarks.shared.pages import Row, table

CALLS = {
    "step": "one step of 2 ms",
    "get_all": "all outputs after a step",
    "get_again": "the same once more",
    "set_one": "one input set",
    "save_restore_free": "state: get, set, free",
    "instantiate_to_initialised": "instantiate to initialised",
}
"""Quantities of `benchmarks.fmu` that are shown."""
HOSTS = {"native from C": ("native", "C"), "native through FMPy": ("native", "FMPy")}
HOSTS |= {"Python from C": ("python", "C"), "Python through FMPy": ("python", "FMPy")}


def fmu_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Microseconds a call by host."""
    found = {(r["quantity"], r["kind"], r["host"]): r["value"] for r in rows}
    lines = [
        {"microseconds": title} | {host: found.get((name, *key)) for host, key in HOSTS.items()}
        for name, title in CALLS.items()
    ]
    return {"fmu calls": table(lines, {"microseconds": "", **dict.fromkeys(HOSTS, ".3g")})}


def wasm_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Least microseconds of an inner step by host."""
    return {"wasm": _crossed(rows, lambda r: f"{r['fidelity']}, {r['what']}", "host", lambda r: f"{r['best_us']:.0f}")}


def plant_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Steps a second and microseconds of processor a step by way and environment."""

    def cell(row: Row) -> str:
        used = row["us_of_processor"]
        return f"{row['steps_a_second']:.0f}" + ("" if used is None else f" ({used:.0f})")

    names = [row | {"column": f"{row['environment']}, {row['step_ms']:g} ms"} for row in rows]
    return {"plant": _crossed(names, lambda r: r["way"], "column", cell, "steps a second (us of processor a step)")}


def _crossed(
    rows: Sequence[Row],
    name: Callable[[Row], str],
    column: str,
    cell: Callable[[Row], str],
    title: str = "fidelity, calls",
) -> str:
    """Rows by name, a column for each value of a key."""
    lines: dict[str, dict[str, str]] = {}
    for row in rows:
        lines.setdefault(name(row), {title: name(row)})[row[column]] = cell(row)
    return table(list(lines.values()), dict.fromkeys([title, *dict.fromkeys(r[column] for r in rows)], ""))
