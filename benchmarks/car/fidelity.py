"""How much model a car needs: errors and cost of the car's levels of fidelity, the cheapest for a tolerance, chart."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.car import fidelity_runs
from benchmarks.car.fidelity_runs import OUTPUTS
from benchmarks.shared.command import pyplot, save_chart
from mbs.scenes.prototype_car.chassis import FIDELITIES, PAPER_MODES, RIGID, reduced_chassis

RUNGS: tuple[int | str, ...] = (0, 1, 2, 3, PAPER_MODES, 4)
TICKS = (25, 50, 100, 200, 400, 800)  # us, of the chart
STRESSES = ("moment", "moment_unfiltered")


@dataclass(frozen=True)
class Choice:
    """The cheapest measured way to an output.

    Attributes
    ----------
    rung : int
    h : float
        Step, s.
    error : float
        Largest over the manoeuvres.
    ms_per_second : float
        Processor time per simulated second, of the slowest manoeuvre.
    left_out : str
        What this rung does without.
    """

    rung: int
    h: float
    error: float
    ms_per_second: float
    left_out: str


def modes_of(rung: int | str) -> int:
    """Number of modes."""
    return 0 if rung in (0, 1) else reduced_chassis(rung).n_modes


def size_of(name: str, rung: int | str) -> dict[str, int]:
    """Columns of the size of a model."""
    arrays = fidelity_runs.system_of(name, rung).arrays
    return {"coordinates": len(arrays["q0"]), "rows": len(arrays["row_const"]), "modes": modes_of(rung)}


def measure(name: str, rung: int | str, h: float, repeats: int) -> dict[str, Any]:
    """One row; errors of stresses are None where there are none."""
    found = fidelity_runs.run(name, rung, h)
    report = found.report
    assert report is not None
    reference = fidelity_runs.read_reference(name)
    error: dict[str, float | None] = dict(fidelity_runs.errors(fidelity_runs.sampled(found, h), reference))
    if rung == RIGID:
        error |= dict.fromkeys(STRESSES)
    duration = float(found.t[-1])
    spent = fidelity_runs.cpu_time(name, rung, h, repeats)
    return {
        "manoeuvre": name,
        "rung": str(rung),
        "h_s": h,
        **size_of(name, rung),
        **error,
        "iterations_mean": report.mean_iterations,
        "iterations_max": report.max_iterations,
        "us_per_step": 1e6 * spent * h / duration,
        "realtime_factor": duration / spent,
    }


def left_out(rung: int) -> str:
    """What a rung does without, in words."""
    texts = {
        0: "deformation and stresses",
        1: "vibration of the frame and what its bending does to the motion; stresses follow the forces at once",
        2: "deformations that no recorded load excites, and vibration that is not in their shapes",
        3: "fixed-interface modes above the fifth",
        4: "fixed-interface modes above the fortieth",
    }
    return texts[rung]


def cheapest(rows: Sequence[dict[str, Any]], output: str, tolerance: float) -> Choice:
    """The rung and step with the least time per simulated second that meet a tolerance in all manoeuvres measured.

    Parameters
    ----------
    rows : sequence of dict
        Of `measure`, or from a JSON file.
    output : str
        One of `fidelity_runs.OUTPUTS`.
    tolerance : float
        On its error: a fraction of the largest change, for "motion" m.
    """
    if output not in OUTPUTS:
        raise ValueError(f"There is no output {output!r}; there are: {', '.join(OUTPUTS)}.")
    if not tolerance > 0.0:
        raise ValueError(f"The tolerance on {output} is {tolerance:g}; it must be positive.")
    names = {row["manoeuvre"] for row in rows}
    found: list[Choice] = []
    smallest = float("inf")
    for rung, h in dict.fromkeys((row["rung"], row["h_s"]) for row in rows):
        if rung == PAPER_MODES:
            continue  # shown for comparison; not a rung
        mine = [row for row in rows if (row["rung"], row["h_s"]) == (rung, h)]
        errors = [row[output] for row in mine]
        if {row["manoeuvre"] for row in mine} != names or any(e is None for e in errors):
            continue
        smallest = min(smallest, max(errors))
        if max(errors) <= tolerance:
            key = int(rung)
            cost = max(1e-3 * row["us_per_step"] / h for row in mine)
            found.append(Choice(key, h, max(errors), cost, left_out(key)))
    if not found:
        raise ValueError(
            f"No rung that was measured has {output} right to {tolerance:g}; the best is {smallest:.2g} away."
        )
    return min(found, key=lambda c: c.ms_per_second)


def chart(rows: Sequence[dict[str, Any]], file: Path) -> None:
    """Stress and motion errors over time per step, one column per manoeuvre."""
    plt = pyplot()
    names = list(dict.fromkeys(row["manoeuvre"] for row in rows))
    parts = (
        ("moment", "gauge moments, low-pass 10 Hz:\nlargest error / largest change"),
        ("motion", "place of the reference point:\nlargest error, m"),
    )
    figure, panels = plt.subplots(2, len(names), figsize=(5.2 * len(names), 8), layout="constrained", squeeze=False)
    colours = dict(
        zip(map(str, RUNGS), ("#222222", "#56B4E9", "#E69F00", "#009E73", "#CC79A7", "#D55E00"), strict=True)
    )
    for column, name in enumerate(names):
        for line, (key, label) in enumerate(parts):
            axes = panels[line][column]
            for rung in dict.fromkeys(row["rung"] for row in rows):
                mine = [r for r in rows if r["manoeuvre"] == name and r["rung"] == rung and r[key] is not None]
                if not mine:
                    continue
                text = f"{rung}: {FIDELITIES[int(rung)]}" if rung.isdigit() else "paper: 60 static and 5 dynamic modes"
                axes.loglog(
                    [r["us_per_step"] for r in mine], [r[key] for r in mine], "o-", color=colours[rung], label=text
                )
                for r in mine:
                    axes.annotate(
                        f"{1e3 * r['h_s']:g} ms",
                        (r["us_per_step"], r[key]),
                        fontsize=7,
                        xytext=(3, 3),
                        textcoords="offset points",
                        color=colours[rung],
                    )
            axes.set_title(name.replace("_", " ") if line == 0 else "")
            axes.set_ylabel(label if column == 0 else "")
            axes.set_xlabel("processor time per step, µs" if line == 1 else "")
            axes.grid(True, alpha=0.25)
            axes.set_xticks([t for t in TICKS if axes.get_xlim()[0] < t < axes.get_xlim()[1]])
            axes.xaxis.set_major_formatter("{x:g}")
            axes.xaxis.set_minor_formatter("")
    handles = {text: h for ax in panels.flat for h, text in zip(*ax.get_legend_handles_labels(), strict=True)}
    handles = dict(sorted(handles.items()))
    figure.legend(list(handles.values()), list(handles), loc="outside lower center", ncols=2, fontsize="small")
    figure.suptitle("The ladder: error against cost on the same manoeuvres")
    save_chart(figure, file)


def verdict(rows: Sequence[dict[str, Any]]) -> list[str]:
    """The cheapest rung for some outputs and tolerances."""
    lines = []
    for output, tolerance in (("motion", 0.02), ("moment", 0.1), ("moment", 0.03), ("moment", 0.01)):
        unit = " m" if output == "motion" else ""
        try:
            c = cheapest(rows, output, tolerance)
        except ValueError as error:
            lines.append(str(error))
            continue
        lines.append(
            f"{output} to {tolerance:g}{unit}: rung {c.rung}, step {1e3 * c.h:g} ms, {c.ms_per_second:.1f} ms per "
            f"simulated second (error {c.error:.2g}{unit}); it leaves out {c.left_out}."
        )
    return lines
