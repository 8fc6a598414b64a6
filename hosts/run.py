"""Runs an FMU with the values that are set: ``ali3 run FMU [--set NAME=VALUE ...] [--stop-time T]``."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from ali3.running import run_command
from hosts.numbers import assignment, number


def main(arguments: Sequence[str] | None = None, prog: str = "python -m hosts.run") -> int:
    """Run the command, which the user typed as `prog`; 0 if every step was accepted."""
    parser = argparse.ArgumentParser(
        prog=prog, description="Run any FMU of FMI 2.0 co-simulation, write its outputs as a table and plot them."
    )
    parser.add_argument("fmu", type=Path, metavar="FMU")
    parser.add_argument(
        "--set",
        type=assignment,
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="start value of a parameter or input, which keeps it; may be given several times",
    )
    parser.add_argument("--stop-time", type=number, metavar="T", help="how long, s; default: that of the FMU")
    parser.add_argument("--step", type=number, metavar="H", help="communication step in s; default: that of the FMU")
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR", help="folder for results; default: out")
    options = parser.parse_args(arguments)
    return run_command(lambda: _run(options.fmu, dict(options.set), options.stop_time, options.step, options.out))


def _run(path: Path, start: dict[str, float], stop_time: float | None, step: float | None, out: Path) -> int:
    import numpy as np

    from hosts.co_simulation import communication_step, run_with_bar
    from hosts.fmu import Fmu
    from hosts.manoeuvre import Manoeuvre
    from hosts.result_files import print_result, result_paths, write_csv
    from hosts.result_plots import plot_page
    from hosts.run_summary import summary

    with Fmu(path) as fmu:
        table, picture = result_paths(out, path.stem)
        experiment = fmu.description.defaultExperiment
        if stop_time is None:
            stop_time = float(experiment.stopTime) if experiment is not None and experiment.stopTime else 10.0
        manoeuvre = Manoeuvre("run", np.zeros(0), {}, stop_time, start)
        step = communication_step(fmu, manoeuvre, step)
        result = run_with_bar(fmu, manoeuvre, step)
    rows = summary(result, step)
    write_csv(result, table)
    plot_page(result, picture, path.stem, rows)
    return print_result((rows,), result, (table, picture))


if __name__ == "__main__":
    sys.exit(main())
