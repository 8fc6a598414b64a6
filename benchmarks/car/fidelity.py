"""Errors and cost of a car's fidelities: rows, the cheapest fidelity for a tolerance, chart."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ali3.errors import UserError
from benchmarks.car import fidelity_runs
from benchmarks.car.accuracy import cost
from benchmarks.car.fidelity_runs import NAMES, OUTPUTS
from benchmarks.shared.command import pyplot, save_chart
from benchmarks.shared.figures import between, rows_of
from benchmarks.shared.pages import Row, table
from mbs import Trajectory
from mbs.scenes import prototype_car
from mbs.vehicle import Fidelity
from mbs.vehicle.levels import level_choice as choice
from mbs.vehicle.levels.level_choice import LevelChoice

STEPS = (0.01, 0.005, 0.002)  # s
COLOURS = {
    Fidelity.TABLE: "#999999",
    Fidelity.RIGID: "#222222",
    Fidelity.QUASI_STATIC: "#56B4E9",
    Fidelity.LOAD_PATHS: "#E69F00",
    Fidelity.DYNAMIC: "#009E73",
    Fidelity.PAPER: "#CC79A7",
    Fidelity.MANY_MODES: "#D55E00",
}
COMPARED = tuple(COLOURS)
TICKS = (25, 50, 100, 200, 400, 800)  # us, of the time axis of the chart
REQUIRED = {
    "place of the car to 2 cm": ("motion", 0.02),
    "moments to 10 %": ("moment", 0.1),
    "moments to 3 %": ("moment", 0.03),
    "moments to 1 %": ("moment", 0.01),
}
STRESSES = ("moment", "moment_unfiltered")


def modes_of(fidelity: Fidelity) -> int:
    """Number of modes of the frame."""
    return (
        0
        if fidelity.rigid or fidelity is Fidelity.QUASI_STATIC
        else prototype_car.car().flexible_frame.reduced(fidelity).n_modes
    )


def size_of(name: str, fidelity: Fidelity) -> dict[str, int]:
    """Numbers of coordinates, constraints and modes of a model."""
    arrays = fidelity_runs.system_of(name, fidelity).arrays
    return {"coordinates": len(arrays["q0"]), "rows": len(arrays["row_const"]), "modes": modes_of(fidelity)}


def errors_of(trajectory: Trajectory, name: str, fidelity: Fidelity, h: float) -> dict[str, float | None]:
    """Errors by `OUTPUTS`; errors of moments are None for a rigid frame."""
    values = fidelity_runs.sampled(trajectory, h, stresses=not fidelity.rigid)
    return dict.fromkeys(STRESSES) | fidelity_runs.errors(values, fidelity_runs.read_reference(name))


def measure(name: str, fidelity: Fidelity, h: float, repeats: int) -> dict[str, Any]:
    """Row of a model: errors and cost. `h`: step, s."""
    run = fidelity_runs.run(name, fidelity, h)
    row = {"manoeuvre": name, "fidelity": fidelity.name.lower(), "h_s": h, **size_of(name, fidelity)}
    system, manoeuvre = fidelity_runs.system_of(name, fidelity), fidelity_runs.manoeuvre_of(name)
    return row | errors_of(run, name, fidelity, h) | cost(system, manoeuvre, run, h, repeats)


def cheapest(rows: Sequence[Row], output: str, tolerance: float) -> LevelChoice:
    """The fidelity and step with the least time per simulated second that meet a tolerance in all measured manoeuvres.

    `rows`: result of `measure`; `output`: one of `fidelity_runs.OUTPUTS`; `tolerance`: largest error of the output,
    relative to its largest change, for "motion" m.
    """
    if output not in OUTPUTS:
        raise ValueError(f"There is no output {output!r}; there are: {', '.join(OUTPUTS)}.")
    return choice.cheapest(rows, {output: tolerance})


def chart(rows: Sequence[Row], file: Path) -> None:
    """Draw errors of moments and motion over time per step, a column of panels for each manoeuvre."""
    plt = pyplot()
    names = list(dict.fromkeys(row["manoeuvre"] for row in rows))
    quantities = (
        ("moment", "gauge moments, low-pass 10 Hz:\nlargest error / largest change"),
        ("motion", "place of the reference point:\nlargest error, m"),
    )
    figure, panels = plt.subplots(2, len(names), figsize=(5.2 * len(names), 8), layout="constrained", squeeze=False)
    for column, name in enumerate(names):
        for line, (key, label) in enumerate(quantities):
            axes = panels[line][column]
            for fidelity in map(Fidelity.of, dict.fromkeys(row["fidelity"] for row in rows)):
                chosen_rows = [r for r in rows if r["manoeuvre"] == name and r["fidelity"] == fidelity.name.lower()]
                chosen_rows = [r for r in chosen_rows if r[key] is not None]
                if not chosen_rows:
                    continue
                text = f"{fidelity.value}: {fidelity.description}"
                axes.loglog(
                    [r["us_per_step"] for r in chosen_rows],
                    [r[key] for r in chosen_rows],
                    "o-",
                    color=COLOURS[fidelity],
                    label=text,
                )
                for r in chosen_rows:
                    axes.annotate(
                        f"{1e3 * r['h_s']:g} ms",
                        (r["us_per_step"], r[key]),
                        fontsize=7,
                        xytext=(3, 3),
                        textcoords="offset points",
                        color=COLOURS[fidelity],
                    )
            axes.set_title(name.replace("_", " ") if line == 0 else "")
            axes.set_ylabel(label if column == 0 else "")
            axes.set_xlabel("processor time per step, µs" if line == 1 else "")
            axes.grid(True, alpha=0.25)
            axes.set_xticks([t for t in TICKS if axes.get_xlim()[0] < t < axes.get_xlim()[1]])
            axes.xaxis.set_major_formatter("{x:g}")
            axes.xaxis.set_minor_formatter("")
    handles = {text: h for ax in panels.flat for h, text in zip(*ax.get_legend_handles_labels(), strict=True)}
    handles = dict(sorted(handles.items(), key=lambda item: int(item[0].partition(":")[0])))
    figure.legend(list(handles.values()), list(handles), loc="outside lower center", ncols=2, fontsize="small")
    figure.suptitle("Fidelities of the car: error against cost on the same manoeuvres")
    save_chart(figure, file)


def choice_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Table of the cheapest fidelity and step for each requirement."""
    lines = []
    for title, (output, tolerance) in REQUIRED.items():
        try:
            level = cheapest(rows, output, tolerance)
        except ValueError as error:
            raise UserError(f"The table of docs/flexible_car.md needs all manoeuvres and steps: {error}") from error
        choice = {
            "cheapest fidelity, step": f"{int(level.fidelity)}, {1e3 * level.h:g} ms",
            "ms per s": f"{level.ms_per_second:.0f}",
        }
        lines.append({"required": title, **choice, "error": _error(output, level.error)})
    return {"cheapest": table(lines, dict.fromkeys(lines[0], ""))}


def choice_again(page: str) -> str:
    """Table of the largest errors of all manoeuvres, for the fidelities that a page has chosen with steps of 10 ms."""
    lines = []
    for row in rows_of(between(page, "cheapest")):
        number, step, _ = row["cheapest fidelity, step"].split()
        if float(step) != 10.0:
            continue
        fidelity, h, output = Fidelity.of(int(number.rstrip(","))), 0.01, REQUIRED[row["required"]][0]
        error = max(errors_of(fidelity_runs.run(name, fidelity, h), name, fidelity, h)[output] for name in NAMES)
        lines.append({"required": row["required"], "error": _error(output, error)})
    return table(lines, dict.fromkeys(lines[0], ""))


def _error(output: str, value: float) -> str:
    return f"{1e3 * value:.1f} mm" if output == "motion" else f"{100.0 * value:.1f} %"
