"""Drives an FMU through a manoeuvre: ``python -m hosts.drive [FMU] --manoeuvre NAME-or-CSV [--fidelity N]``."""

from __future__ import annotations

import argparse
import csv
import re
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from tqdm import tqdm

from hosts.driver import make_driver
from hosts.errors import HostError
from hosts.fmu import Fmu
from hosts.manoeuvre import load_manoeuvre, manoeuvre_names
from hosts.plot_page import plot_page
from hosts.run import Result, run
from hosts.summary import energy_balance, summary

DEFAULT_FMU = Path("dist", "PrototypeCar.fmu")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; 0 if every step was accepted."""
    parser = argparse.ArgumentParser(prog="python -m hosts.drive", description="Drive an FMU through a manoeuvre.")
    parser.add_argument("fmu", nargs="?", type=Path, default=DEFAULT_FMU, metavar="FMU", help=f"default: {DEFAULT_FMU}")
    parser.add_argument(
        "--manoeuvre",
        "-m",
        required=True,
        help=f"CSV file with time and inputs, or one of: {', '.join(manoeuvre_names())}",
    )
    parser.add_argument("--step", type=float, metavar="H", help="communication step in s; default: that of the FMU")
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR", help="folder for results; default: out")
    parser.add_argument("--fidelity", type=float, metavar="N", help="how much model, where the FMU offers a choice")
    options = parser.parse_args(arguments)
    try:
        return _drive(options.fmu, options.manoeuvre, options.step, options.out, options.fidelity)
    except HostError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2


def _drive(path: Path, name: str, step: float | None, out: Path, fidelity: float | None) -> int:
    manoeuvre = load_manoeuvre(name)
    if fidelity is not None:
        manoeuvre = replace(manoeuvre, start=manoeuvre.start | {"fidelity": fidelity})
    with Fmu(path) as fmu:
        driver = make_driver(manoeuvre.driver, fmu.constants()) if manoeuvre.driver else None
        experiment = fmu.description.defaultExperiment
        if step is None:
            step = float(experiment.stepSize) if experiment is not None and experiment.stepSize else 0.01
        if not 0.0 < step <= manoeuvre.stop_time:
            raise HostError(f"The step is {step} s; it must be positive and not longer than {manoeuvre.stop_time:g} s.")
        with tqdm(total=round(manoeuvre.stop_time / step), desc=f"{path.stem}, {manoeuvre.name}", unit="step") as bar:
            result = run(fmu, manoeuvre, step, driver, lambda done: bar.update(done - bar.n))
    course = driver.course if driver is not None else None
    outline = (driver.settings.vehicle_length, driver.settings.vehicle_width) if driver is not None else (0.0, 0.0)
    rows = summary(result, step, course, outline)
    make_folder(out)
    stem = out / f"{_words(path.stem)}_{manoeuvre.name}"
    table, picture = stem.with_name(stem.name + ".csv"), stem.with_name(stem.name + ".png")
    write_csv(result, table)
    title = f"{path.stem}: {manoeuvre.name.replace('_', ' ')}"
    plot_page(result, picture, title, rows, course)
    for table_rows in (rows, energy_balance(result)):
        width = max((len(what) for what, _ in table_rows), default=0)
        for what, value in table_rows:
            print(f"{what:<{width}}  {value}")
    for message in dict.fromkeys(result.messages):
        print(f"FMU: {message}")
    print(f"written: {table}, {picture}")
    return 1 if result.failed_steps else 0


def make_folder(out: Path) -> None:
    """The folder for results, if it is not there."""
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise HostError(f"The folder {out} cannot be made: {error.strerror}.") from None


def write_csv(result: Result, file: Path) -> None:
    """Time, inputs and outputs as a table in FMPy's format.

    Parameters
    ----------
    result : Result
    file : Path
    """
    with file.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, quoting=csv.QUOTE_NONNUMERIC)
        writer.writerow(["time", *result.names])
        for t, row in zip(result.time.tolist(), result.values.tolist(), strict=True):
            writer.writerow([t, *row])


def _words(name: str) -> str:
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()


if __name__ == "__main__":
    sys.exit(main())
