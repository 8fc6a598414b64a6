"""The paper's test in one picture: ``ali3 kerb [FMU] [--fidelity N] [--step H] [--out DIR]``.

Runs the FMU of the scene kerb_test for 15 s and draws the bending moments at the gauges, unfiltered and after a
low-pass of 10 Hz, with the three intervals of the paper's Figure 8 marked. All through FMI.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ali3.running import command_name, run_command
from hosts.common.errors import HostError
from hosts.common.numbers import number
from hosts.common.options import Wishes, add_setting_options, wishes

if TYPE_CHECKING:
    from hosts.driving.co_simulation import Result

DEFAULT_FMU = Path("dist", "KerbTest.fmu")
DURATION = 15.0  # s
INTERVALS = ((0.0, 5.0, "at rest"), (5.0, 10.0, "moving"), (10.0, 15.0, "at rest"))  # s
GAUGES = ("SG1", "SG2", "SG3", "SG4")
PLACES = {"SG1": "front left", "SG2": "front right", "SG3": "rear left", "SG4": "rear right"}
FREQUENCY = 10.0  # Hz


def main(arguments: Sequence[str] | None = None, prog: str = "python -m hosts.run.kerb") -> int:
    """Run the command, which the user typed as `prog`; 0 if every step was accepted."""
    parser = argparse.ArgumentParser(
        prog=prog, description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("fmu", nargs="?", type=Path, default=DEFAULT_FMU, metavar="FMU", help=f"default: {DEFAULT_FMU}")
    parser.add_argument("--fidelity", type=number, metavar="N", help="1 to 3; default: that of the FMU")
    parser.add_argument("--step", type=number, default=0.01, metavar="H", help="communication step, s; default: 0.01")
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR", help="folder for results; default: out")
    add_setting_options(parser)
    options = parser.parse_args(arguments)
    return run_command(lambda: _kerb(options.fmu, options.fidelity, options.step, options.out, wishes(options)))


def _kerb(path: Path, fidelity: float | None, step: float, out: Path, given: Wishes) -> int:
    import numpy as np

    from hosts.driving.co_simulation import communication_step, run_with_bar
    from hosts.driving.manoeuvre import Manoeuvre
    from hosts.driving.manoeuvre_settings import set_in
    from hosts.fmu.fmu import Fmu
    from hosts.run.result_files import print_result, result_paths, write_csv, write_record

    if not 0.0 < step < 0.5 / FREQUENCY:
        raise HostError(f"The step is {step:g} s; it must be positive and below {0.5 / FREQUENCY:g} s for the filter.")
    build = f"{command_name('build')} --scene kerb_test"
    if not path.is_file() and path == DEFAULT_FMU:
        raise HostError(f"There is no file {path}. Build it with: {build}")
    manoeuvre = Manoeuvre("kerb_test", np.zeros(0), {}, DURATION)
    with Fmu(path) as fmu:
        missing = [f"bending_moment.{g}" for g in GAUGES if f"bending_moment.{g}" not in fmu.variables]
        if missing:
            raise HostError(f"{path} has no {missing[0]}; build the scene of this test: {build}")
        table, picture, record = result_paths(out, "kerb_test")
        manoeuvre, settings = set_in(fmu, manoeuvre, given, fidelity)
        result = run_with_bar(fmu, manoeuvre, communication_step(fmu, manoeuvre, step))
    if result["stress.computed"][0] != 1.0:
        raise HostError("At this fidelity the moments are not computed (stress.computed is 0); take 1, 2 or 3.")
    write_csv(result, table)
    write_record(fmu, manoeuvre.name, step, settings, result, record)
    rows = moments(result, step)
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
    """Per gauge: value at rest, range before and after the filter as differences from it, what is left at the end."""
    from hosts.measures.low_pass import low_pass

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
    from matplotlib import pyplot as plt

    from hosts.measures.low_pass import low_pass
    from hosts.run.result_plots import BLACK, BLUE, RED, save_picture

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
        axes.set_title(f"{gauge}, {PLACES[gauge]} (at rest {x[0]:.2f} N m)", loc="left", pad=16, fontsize=11)
        axes.set_ylabel("bending moment less that at rest, N m")
        axes.grid(True, alpha=0.3)
        axes.margins(x=0)
    panels[0, 0].legend(loc="upper left")
    for axes in panels[-1]:
        axes.set_xlabel("time, s")
    figure.suptitle("Prototype car down a kerb of 8 cm: the setting of the paper's Figure 8", fontsize=14)
    save_picture(figure, file)


if __name__ == "__main__":
    sys.exit(main())
