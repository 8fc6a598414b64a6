"""The paper's kerb test in one picture: ``ali3 run --kerb``.

Runs the FMU of the scene kerb_test for 15 s and draws the bending moments at the gauges, unfiltered and after a
low-pass of 10 Hz, with the three intervals of the paper's Figure 8 marked. All through FMI.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib import pyplot as plt

from ali3.chart_style import BLACK, BLUE, RED
from ali3.charts import save_picture
from ali3.locks import locked
from ali3.low_pass import low_pass
from ali3.processes import command_name
from hosts.common.errors import HostError
from hosts.common.options import FmuOptions
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.manoeuvre_settings import apply_settings
from hosts.driving.run_checks import communication_step
from hosts.driving.runs_with_progress import run_with_bar
from hosts.fmu.built_fmu import fmu_of_scene
from hosts.fmu.fmu import Fmu
from hosts.run.result_files import print_result, result_paths, write_csv, write_record

if TYPE_CHECKING:
    from hosts.driving.result import Result

SCENE = "kerb_test"
DIST = Path("dist", "KerbTest.fmu")
STEP = 0.01  # s
DURATION = 15.0  # s
INTERVALS = ((0.0, 5.0, "at rest"), (5.0, 10.0, "moving"), (10.0, 15.0, "at rest"))  # s
GAUGES = ("SG1", "SG2", "SG3", "SG4")
POSITIONS = {"SG1": "front left", "SG2": "front right", "SG3": "rear left", "SG4": "rear right"}
FREQUENCY = 10.0  # Hz


def kerb_test(file: Path | None, fidelity: float | None, step: float | None, out: Path, options: FmuOptions) -> int:
    """Run the test, print its moments and write its files.

    `file`: FMU of the scene; by default `DIST`, else one that is built and cached; `fidelity`: 1 to 3; by default that
    of the FMU; `step`: communication step, s; by default `STEP`. Result: exit code. Raises `HostError`: the step is too
    long for the filter, or the FMU is none of this scene.
    """
    step = STEP if step is None else step
    if not 0.0 < step < 0.5 / FREQUENCY:
        raise HostError(f"The step is {step:g} s; it must be positive and below {0.5 / FREQUENCY:g} s for the filter.")
    path = file if file is not None else DIST if DIST.is_file() else fmu_of_scene(SCENE, print)
    manoeuvre = Manoeuvre(SCENE, np.zeros(0), {}, DURATION)
    with Fmu(path) as fmu:
        missing = [f"bending_moment.{g}" for g in GAUGES if f"bending_moment.{g}" not in fmu.variables]
        if missing:
            raise HostError(
                f"{path} has no {missing[0]}; build the scene of this test: {command_name('build')} --scene {SCENE}"
            )
        table, picture, record = result_paths(out, "kerb_test")
        manoeuvre, settings = apply_settings(fmu, manoeuvre, options, fidelity)
        result = run_with_bar(fmu, manoeuvre, communication_step(fmu, manoeuvre, step))
    if result["stress.computed"][0] != 1.0:
        raise HostError(f"{path} does not compute the moments (stress.computed is 0); build it with all fidelities.")
    rows = moments(result, step)
    with locked(out):  # of several runs into one folder all files of one stay
        write_csv(result, table)
        write_record(fmu, manoeuvre, step, settings, result, record)
        draw(result, step, picture)
    print(f"{'gauge':<6}{'rest':>9}{'range':>18}{'filtered range':>18}{'end - rest':>12}   N m")
    for row in rows:
        print(
            f"{row['gauge']:<6}{row['rest']:>9.3f}{row['low']:>9.2f}{row['high']:>9.2f}"
            f"{row['filtered_low']:>9.2f}{row['filtered_high']:>9.2f}{row['left']:>12.3f}"
        )
    n = result["solver.iterations"][1:]
    print(
        f"Newton iterations {n.mean():.2f} a step, {n.max():.0f} at most; real-time factor {DURATION / result.wall:.1f}"
    )
    return print_result((settings.rows(),), result, (table, picture, record))


def moments(result: Result, step: float) -> list[dict[str, float | str]]:
    """Moment of each gauge at rest, and range before and after the filter and end as differences from it, N m."""
    rows: list[dict[str, float | str]] = []
    for gauge in GAUGES:
        x = result[f"bending_moment.{gauge}"]
        change = x - x[0]
        filtered = low_pass(change, step, FREQUENCY)
        rows.append(
            {
                "gauge": gauge,
                "rest": float(x[0]),
                "low": float(change.min()),
                "high": float(change.max()),
                "filtered_low": float(filtered.min()),
                "filtered_high": float(filtered.max()),
                "left": float(change[-1]),
            }
        )
    return rows


def draw(result: Result, step: float, file: Path) -> None:
    """Moments as differences from rest, as gauges measure them."""
    figure, panels = plt.subplots(2, 2, figsize=(15, 8), sharex=True, layout="constrained")
    for axes, gauge in zip(panels.T.flat, GAUGES, strict=True):
        x = result[f"bending_moment.{gauge}"]
        axes.plot(result.time, x - x[0], color=BLUE, linewidth=0.9, label="unfiltered")
        axes.plot(result.time, low_pass(x - x[0], step, FREQUENCY), color=RED, linewidth=1.8, label="low-pass 10 Hz")
        for begin, end, label in INTERVALS:
            if label == "moving":
                axes.axvspan(begin, end, color="#f2f2f2", zorder=0)
            axes.text(0.5 * (begin + end), 1.0, label, transform=axes.get_xaxis_transform(), ha="center", va="bottom")
        axes.axhline(0.0, color=BLACK, linewidth=0.6)
        axes.set_title(f"{gauge}, {POSITIONS[gauge]} (at rest {x[0]:.2f} N m)", loc="left", pad=16, fontsize=11)
        axes.set_ylabel("bending moment less that at rest, N m")
        axes.grid(True, alpha=0.3)
        axes.margins(x=0)
    panels[0, 0].legend(loc="upper left")
    for axes in panels[-1]:
        axes.set_xlabel("time, s")
    figure.suptitle("Prototype car down a kerb of 8 cm: the setting of the paper's Figure 8", fontsize=14)
    save_picture(figure, file)
