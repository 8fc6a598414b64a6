"""Free mechanisms with each joint and each force: errors of energy, gear ratios and angles after many steps."""

import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

import mbs
from benchmarks.methods.free_elements import ELEMENTS
from benchmarks.methods.free_wheels import TWO_AXES, WHEELS, angle_error_alone
from benchmarks.shared.command import pyplot, save_chart
from benchmarks.shared.pages import Row, crossed, table
from mbs.settings.methods import METHOD_TABLE

STEP = 0.01  # s
STEPS = 100_000
EVERY = 10  # steps between recorded instants
TURNS = (0.01, 0.05, 0.2, 0.5)
"""Rate of the fastest wheel, or of the load, times the step, rad."""
MAX_CHANGE = 1e-3
"""Relative change of the energy from which a run should report an error."""
MECHANISMS = WHEELS | TWO_AXES | ELEMENTS


def measure(
    name: str, turn: float, steps: int = STEPS, method: str = "ali3p", with_check: bool = False
) -> dict[str, Any]:
    """Row of a run: relative errors of energy less work, of gear ratios (`slip`) and of angles (`late`).

    `drift`: mean change of the energy in a step; `grows`: whether the drift is most of the change. `with_check`: repeat
    a wrong run with the check of its accuracy.
    """
    free = MECHANISMS[name](turn / STEP)
    every, row = min(EVERY, steps), {"mechanism": name, "turn": turn, "method": method}
    system = free.compiled()
    options: dict[str, Any] = {"method": method, "inputs": free.inputs, "every": every, "progress": False}
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", mbs.BendingWarning)  # the energy is that of the linear modes
            r = mbs.simulate(system, steps * STEP, STEP, estimate_error=False, **options)
        row["told"] = ""
    except mbs.SimulationError as error:
        if error.time == 0.0 or error.trajectory is None or len(error.trajectory.t) < 2:
            return row | {"told": "refused" if error.time > 0.0 else "no", "energy": None, "drift": None}
        r, row["told"] = error.trajectory, "refused"
    steps = every * (len(r.t) - 1)
    work = r["work"] if free.model.elements or free.model.guides else 0.0 * r.t
    change = r["energy"] - r["energy"][0] - work
    tenth = max(1, len(change) // 10)
    change /= max(r["energy"][0], np.max(np.abs(work[:tenth])))
    drift = float(np.mean(change[-tenth:]) - np.mean(change[:tenth])) / (0.9 * steps)
    row |= {"energy": float(np.max(np.abs(change))), "drift": drift}
    row["grows"] = abs(drift) * steps > 0.5 * row["energy"]
    if r.report is not None:
        row |= {"iterations": r.report.iterations / steps, "halvings": r.report.halvings}
    if with_check and row["energy"] > MAX_CHANGE and not row["told"]:
        with warnings.catch_warnings(record=True) as caught_warnings:
            warnings.simplefilter("always")
            checked = mbs.simulate(system, steps * STEP, STEP, **options)
        kinds = {w.category.__name__ for w in caught_warnings} | {"notice" for _ in checked.notices}
        row["told"] = ", ".join(sorted(kinds))
    if free.angles:
        travel = {
            end: r[end] - r[end][0] for end in {*free.angles, *(end for pair in free.couplings for end in pair[:2])}
        }
        slips = [np.max(np.abs(travel[a] - i * travel[b])) / np.max(np.abs(travel[a])) for a, b, i in free.couplings]
        late = [np.max(np.abs(travel[a] - rate * r.t)) for a, (_, rate) in free.angles.items()]
        row |= {"slip": float(max(slips, default=0.0)), "late": float(max(late) / (turn * steps))}
        row["alone_late"] = angle_error_alone(turn)
    return row


def rows(names: Sequence[str], methods: Sequence[str], steps: int) -> list[dict[str, Any]]:
    """Rows of all mechanisms, methods and rates."""
    return [measure(name, turn, steps, method, True) for name in names for method in methods for turn in TURNS]


def blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Tables of the page."""
    lines: dict[str, dict[str, Any]] = {}
    for row in rows:
        if row["method"] == "ali3p" and row["mechanism"] in WHEELS | TWO_AXES and row["energy"] is not None:
            line = lines.setdefault(row["mechanism"], {"mechanism": row["mechanism"]})
            line |= {"slip": max(row["slip"], line.get("slip", 0.0)), f"late at {row['turn']:g}": row["late"]}
    heads = ("slip", f"late at {TURNS[0]:g}", f"late at {TURNS[-1]:g}")
    cells = {(row["mechanism"], row["method"]): cell(rows, row["mechanism"], row["method"]) for row in rows}
    one = [{"mechanism": name, "method": method, "cell": text} for (name, method), text in cells.items()]
    return {
        "gears": table([*lines.values()], {"mechanism": ""} | dict.fromkeys(heads, ".1e")),
        "free": crossed(one, lambda r: r["mechanism"], "method", lambda r: r["cell"], "mechanism"),
        "free wrong": table(
            [row for row in rows if row["energy"] is not None and row["energy"] > MAX_CHANGE and not row["told"]],
            {"mechanism": "", "method": "", "turn": "g", "energy": ".1e", "drift": ".1e"},
        ),
    }


def cell(rows: Sequence[Row], name: str, method: str) -> str:
    """Text of a cell: largest change over the rates, the rate from which it exceeds `MAX_CHANGE`, and refusals."""
    own_rows = sorted((r for r in rows if (r["mechanism"], r["method"]) == (name, method)), key=lambda r: r["turn"])
    ran = [row for row in own_rows if row["energy"] is not None]
    if not ran:
        return "–" if all(row["told"] == "no" for row in own_rows) else "refused"
    text = f"{max(row['energy'] for row in ran):.0e}"
    wrong = [row for row in ran if row["energy"] > MAX_CHANGE]
    if wrong:
        text += f" from {wrong[0]['turn']:g}" + (", grows" if any(row.get("grows") for row in wrong) else "")
        text += "" if all(row["told"] for row in wrong) else " (!)"
    refused = [row["turn"] for row in own_rows if row["told"] == "refused"]
    return text + (f", refused from {refused[0]:g}" if refused else "")


def draw(rows: Sequence[Row], folder: Path) -> None:
    """Draw the largest change of the energy as a map of mechanisms over methods and rates."""
    plt = pyplot()
    methods = list(dict.fromkeys(row["method"] for row in rows))
    names = list(dict.fromkeys(row["mechanism"] for row in rows))
    figure, axes = plt.subplots(figsize=(9.5, 2.0 + 0.2 * len(names)), layout="constrained")
    change = np.full((len(names), len(methods) * len(TURNS)), np.nan)
    for row in rows:
        column = methods.index(row["method"]) * len(TURNS) + TURNS.index(row["turn"])
        if row["energy"] is not None:
            change[names.index(row["mechanism"]), column] = np.log10(max(row["energy"], 1e-12))
    image = axes.imshow(change, vmin=-9.0, vmax=0.0, aspect="auto", cmap="RdYlGn_r")
    for k in range(1, len(methods)):
        axes.axvline(k * len(TURNS) - 0.5, color="k", linewidth=0.8)
    middle = 0.5 * (len(TURNS) - 1)
    titles = [METHOD_TABLE[m].title for m in methods]
    axes.set_xticks([k * len(TURNS) + middle for k in range(len(methods))], titles, rotation=20, ha="right")
    axes.set_yticks(range(len(names)), names, fontsize=8)
    rates = ", ".join(f"{turn:g}" for turn in TURNS)
    axes.set_title(f"Largest change of energy; columns of a method: rate x step {rates}; white: not taken")
    figure.colorbar(image, label="log10 of the part of the energy", shrink=0.5)
    save_chart(figure, folder / "stability_free.png")
