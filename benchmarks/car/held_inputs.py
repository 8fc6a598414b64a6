"""Errors of a car's FMU over the communication step: inputs held, extrapolated, or updated within a step."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks.car import manoeuvres, trajectories
from benchmarks.car.accuracy import TITLES
from benchmarks.car.fmu_runs import run_of_fmu
from benchmarks.shared.command import pyplot, save_chart
from benchmarks.shared.pages import Row, table

MANOEUVRES = ("double_lane_change_replay", "step_steer_given_throttle")
STEPS = (0.002, 0.005, 0.01, 0.02, 0.04)
"""Communication steps, s; each is a whole number of inner steps."""
INNER = 0.001  # inner step, s
INTERPOLATIONS = {
    "held": ("native", False, "inputs held"),
    "derivatives": ("native", True, "derivatives of FMI 2.0"),
    "within": ("fmi3_scalar", True, "intermediate update of FMI 3.0"),
}
"""By interpolation of the inputs: kind of FMU, whether inputs have derivatives, title."""


def error(fmu: Path, name: str, step: float, follow: bool) -> float:
    """Largest position error of the car at communication points divided by the path length. `step`: communication
    step, s.
    """
    _, values, length = trajectories.read(name)
    result = run_of_fmu(fmu, name, step, follow, inner=INNER)
    every = max(1, round(step / manoeuvres.sampling(name)))
    return trajectories.path_error(result, {n: values[n][::every] for n in trajectories.POSITION}) / length


def measure(fmus: dict[str, Path], names: Sequence[str] = MANOEUVRES) -> list[dict[str, Any]]:
    """Rows by manoeuvre and communication step, with the errors of the three interpolations; `fmus`: FMUs by kind."""
    return [
        {"manoeuvre": TITLES[name], "H, ms": 1000.0 * step}
        | {title: error(fmus[kind], name, step, follow) for kind, follow, title in INTERPOLATIONS.values()}
        for name in names
        for step in STEPS
    ]


def blocks(rows: Sequence[Row]) -> dict[str, str]:
    """The table of the page."""
    forms = {"manoeuvre": "", "H, ms": "g"} | {title: ".1e" for *_, title in INTERPOLATIONS.values()}
    return {"errors over the communication step": table(rows, forms)}


def draw(rows: Sequence[Row], file: Path) -> None:
    """Draw the errors over the communication step, a panel for each manoeuvre."""
    names = list(dict.fromkeys(row["manoeuvre"] for row in rows))
    figure, axes = pyplot().subplots(1, len(names), figsize=(4.2 * len(names), 3.6), sharey=True, layout="constrained")
    for name, ax in zip(names, axes, strict=True):
        manoeuvre_rows = [row for row in rows if row["manoeuvre"] == name]
        for (*_, title), mark in zip(INTERPOLATIONS.values(), ("o-", "s-", "x--"), strict=True):
            ax.loglog(
                [row["H, ms"] for row in manoeuvre_rows], [row[title] for row in manoeuvre_rows], mark, label=title
            )
        ax.set_title(name)
        ax.set_xlabel("communication step, ms")
        ax.set_xticks([1000.0 * step for step in STEPS], [f"{1000.0 * step:g}" for step in STEPS])
        ax.minorticks_off()
        ax.grid(visible=True, alpha=0.3)
    axes[0].set_ylabel("error of the place over the path")
    axes[0].legend(loc="center left")
    save_chart(figure, file)
