"""The result of a comparison, and its files: signals side by side as CSV, measures as JSON, the report, the fit."""

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from ali3.charts import drawing
from ali3.files import atomic_file, check_writable, write_json
from ali3.write_parameter_set import write_parameter_set
from hosts.common.numbers import or_null
from hosts.compare.comparison import Comparison, measures
from hosts.compare.fit_result import Fit
from hosts.compare.report import comparison_figure, write_report
from hosts.compare.task import Task
from hosts.compare.windows import bins, windows
from hosts.fmu.fmu import described
from hosts.fmu.parameters_as_set import parameter_set_of
from hosts.fmu.variables import Variables


@dataclass(frozen=True)
class Outcome:
    """The outcome of a comparison: results before and after a fit, notes and problems."""

    before: Comparison
    """Comparison with the parameters of the FMU."""
    after: Comparison | None
    """Comparison with fitted parameters, if there are any."""
    fit: Fit | None
    notes: list[str]
    problems: list[str]

    @property
    def best(self) -> Comparison:
        """The comparison with fitted parameters if there are any, otherwise that before."""
        return self.before if self.after is None else self.after


def paths_of(options: argparse.Namespace) -> dict[str, Path]:
    """Paths of the files that are written, by suffix. Raises `FileError` if one cannot be written."""
    kinds = [".html", ".svg", ".csv", *([".ssv"] if options.fit else [])]
    paths = {kind: options.out / f"{options.log.stem}{kind}" for kind in kinds}
    for file in paths.values():
        check_writable(file)
    if options.json is not None:
        paths[".json"] = options.json
    if paths[".csv"].resolve() == options.log.resolve():
        paths[".csv"] = options.out / f"{options.log.stem}_compared.csv"  # never over the log
    return paths


def write_outcome(
    options: argparse.Namespace, task: Task, outcome: Outcome, paths: Mapping[str, Path]
) -> Sequence[Path]:
    """Write all files of a comparison. Returns their paths."""
    title = f"{options.fmu.stem} and {options.log.name}"
    write_signals(outcome.before, outcome.after, paths[".csv"])
    error_bins = bins(outcome.best, task.scales)
    caption = (
        f"{title}: {', '.join(outcome.before.signals)}, measured and simulated, over time, and what remains of each."
    )
    figure = drawing(comparison_figure(outcome.before, outcome.after, title, task.inputs), caption)
    write_report(
        title, outcome.before, outcome.after, outcome.fit, error_bins, outcome.notes, outcome.problems, paths, figure
    )
    if outcome.fit is not None:
        values = task.fmu.fmu_values(dict(task.set_values) | outcome.fit.parameters)
        description = described(options.fmu)
        parameters = parameter_set_of(Variables(description), description.modelName, values)
        write_parameter_set(parameters, paths[".ssv"], as_built=False)
    if ".json" in paths:
        write_json(paths[".json"], _record(outcome, task))
    return [file for kind, file in paths.items() if kind != ".ssv" or outcome.fit is not None]


def _record(outcome: Outcome, task: Task) -> dict[str, Any]:
    record: dict[str, Any] = {
        "step_s": task.step,
        "start": task.segments[0].manoeuvre.start,
        "notes": outcome.notes,
        "problems": outcome.problems,
        "measures": [{"name": m.name, **m.record()} for m in measures(outcome.before)],
        "bins": [asdict(b) for b in bins(outcome.best, task.scales)],
    }
    if task.windowed:
        record["windows"] = [asdict(w) for w in windows(outcome.best, task.segments)]
    if outcome.fit is not None and outcome.after is not None:
        f = outcome.fit
        record["fitted_measures"] = [{"name": m.name, **m.record()} for m in measures(outcome.after)]
        record["fit"] = {
            "found": [
                {
                    "name": x.unknown.name,
                    "unit": x.unknown.unit,
                    "start": x.unknown.start,
                    "value": x.value,
                    "half_width_95": or_null(x.half_width),
                    "bound": x.bound,
                    "without": or_null(x.without),
                    "folds": x.folds,
                }
                for x in f.found
            ],
            "correlation": f.correlation.tolist(),
            "residual_before": f.before,
            "residual_after": f.after,
            "chance": f.chance,
            "noise": f.noise,
            "remains": f.misfit,
            "computed_noise": f.computed_noise,
            "samples": f.samples,
            "effective_samples": f.effective,
            "runs": f.runs,
            "converged": f.converged,
            "starts": [asdict(start) for start in f.starts],
            "refused_starts": f.refused,
            "left_out": {n: or_null(x) for n, x in f.left_out.items()},
            "criterion": f.criterion,
        }
    return record


def write_signals(before: Comparison, after: Comparison | None, file: Path) -> None:
    """Write the signals as CSV at all times of samples; a cell is empty if a signal has no sample.

    `after`: comparison with fitted parameters. Columns: ``time [s]``, then of each signal ``NAME.measured``,
    ``NAME.simulated`` and, with fitted parameters, ``NAME.fitted``, with the unit.
    """
    times = np.unique(np.concatenate([s.measured.time for s in before.signals.values()]))
    columns: dict[str, Any] = {}
    for name, s in before.signals.items():
        columns[f"{name}.measured [{s.measured.unit}]"] = pd.Series(s.measured.values, s.measured.time)
        columns[f"{name}.simulated [{s.measured.unit}]"] = pd.Series(s.simulated(times), times)
        if after is not None:
            columns[f"{name}.fitted [{s.measured.unit}]"] = pd.Series(after.signals[name].simulated(times), times)
    with atomic_file(file) as path:
        pd.DataFrame(columns, times).to_csv(path, index_label="time [s]", lineterminator="\r\n")
