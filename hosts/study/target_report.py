"""The report of a search for a target value: sentences, a record and a figure."""

from __future__ import annotations

import math
from dataclasses import asdict
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib import pyplot as plt

from ali3.chart_style import BLUE, RED, STYLE
from ali3.files import write_json
from hosts.common.display_units import number_in, titled
from hosts.common.numbers import or_null
from hosts.fmu.fmu import described
from hosts.fmu.variables import Variable, Variables
from hosts.study.analysis.data import without_round_off
from hosts.study.target_runs import TargetRuns
from hosts.study.target_search import TOLERANCE, Run, SearchResult

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def text_lines(runs: TargetRuns, search: SearchResult) -> list[str]:
    """Sentences on the result of a search."""
    by, name, failed = runs.target.by, runs.column, [r for r in search.runs if r.reason]
    lines = []
    if search.best is None:
        lines.append(f"No run yields {name}: {failed[0].reason.rstrip('.')}. Give another --between.")
    elif search.met:
        lines.append(f"{by} = {runs.x_text(search.best.x)} gives {name} = {runs.y_text(search.best.y)}.")
        lines.append(f"Wanted: {runs.y_text(runs.target_value)}, to within {TOLERANCE:g} of it.")
    else:
        lines += _unmet_lines(runs, search, search.best)
    if search.best is not None and math.isfinite(search.slope) and not _is_flat(runs, search):
        slope, lower, upper = runs.display.factor * search.slope, *map(runs.x_text, search.between)
        change = number_in(0.01 * search.best.x * slope, runs.display.unit, ".5g")
        lines.append(f"Sensitivity: 1 % more of {by} changes it by {change} (from runs at {lower} and {upper}).")
    if search.met and search.rises and search.falls:
        lines.append(f"It is not monotone over {by} in these runs: another value may give the same.")
    if failed and search.best is not None:
        count = "1 run" if len(failed) == 1 else f"{len(failed)} runs"
        lines.append(f"{count} failed, the first at {runs.x_text(failed[0].x)}: {failed[0].reason}")
    lines.append(f"{len(search.runs)} runs of {runs.job.label}.")
    return lines


def _unmet_lines(runs: TargetRuns, search: SearchResult, best: Run) -> list[str]:
    ys = [run.y for run in search.runs if not run.reason]
    low, high = runs.y_text(min(ys)), runs.y_text(max(ys))
    ends = " to ".join(runs.x_text(x) for x in (runs.parameter.low, runs.parameter.high))
    lines = [
        f"{runs.column} = {runs.y_text(runs.target_value)} is not met with {runs.target.by} from {ends}.",
        f"The nearest is {runs.y_text(best.y)}, at {runs.x_text(best.x)}; the runs lie between {low} and {high}.",
    ]
    changes = (False, False) if _is_flat(runs, search) else (search.rises, search.falls)
    change = {(True, True): "is not monotone", (True, False): "only rises", (False, True): "only falls"}.get(
        changes, "does not change"
    )
    if search.crossed:
        left, right = _bracketing_runs(runs, search)
        lines.append(
            f"Between {runs.x_text(left.x)} and {runs.x_text(right.x)} the measure goes from "
            f"{runs.y_text(left.y)} to {runs.y_text(right.y)}: it jumps there, runs fail, or the range is too "
            f"wide to resolve it; try --between={left.x:.6g}:{right.x:.6g}."
        )
        return lines
    variable = _variable(runs)
    at_end = best.x in (runs.parameter.low, runs.parameter.high)
    can_widen = at_end and change != "does not change" and (variable is None or variable.low < best.x < variable.high)
    allowed = f" (the FMU allows {variable.range})" if variable is not None and variable.range else ""
    remedy = f"a wider range, --between{allowed}" if can_widen else "another parameter (--by)"
    lines.append(
        f"In {len(ys)} runs from end to end the measure {change} with it and does not reach what is wanted; "
        f"try {remedy}."
    )
    return lines


def _is_flat(runs: TargetRuns, search: SearchResult) -> bool:
    """Whether the measure varies by rounding errors only."""
    values = np.array([run.y for run in search.runs if not run.reason])
    return len(values) > 1 and not np.ptp(without_round_off(values, runs.unit))


def _finished_runs(search: SearchResult) -> list[Run]:
    """Runs with a value of the measure, in the order of the parameter."""
    return sorted((run for run in search.runs if not run.reason), key=lambda run: run.x)


def _bracketing_runs(runs: TargetRuns, search: SearchResult) -> tuple[Run, Run]:
    """The closest two runs on different sides of the target value."""
    sides = [
        (a, b)
        for a, b in pairwise(_finished_runs(search))
        if (a.y - runs.target_value) * (b.y - runs.target_value) <= 0.0
    ]
    return min(sides, key=lambda pair: pair[1].x - pair[0].x)


def _variable(runs: TargetRuns) -> Variable | None:
    variables = Variables(described(runs.plan.fmu))
    return variables[runs.target.by] if runs.target.by in variables.names else None


def write_search_record(runs: TargetRuns, search: SearchResult, lines: list[str], file: Path) -> Path:
    """Write the search as JSON, in the units of the measure and of the FMU. Returns the path."""
    record = {
        "measure": runs.column,
        "unit": runs.unit,
        "wanted": runs.target_value,
        "parameter": runs.target.by,
        "parameter_unit": runs.parameter.unit,
        "range": [runs.parameter.low, runs.parameter.high],
        "met": search.met,
        "tolerance": search.tolerance,
        "value": None if search.best is None else search.best.x,
        "reached": None if search.best is None else search.best.y,
        "sensitivity": or_null(search.slope),
        "runs": [{**asdict(run), "y": or_null(run.y)} for run in search.runs],
        "words": lines,
    }
    write_json(file, record)
    return file


def search_figure(runs: TargetRuns, search: SearchResult) -> Figure:
    """The measure over the parameter in all runs."""
    factor, unit = runs.display.factor, runs.display.unit
    finished = _finished_runs(search)
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(figsize=(8.0, 4.5), layout="constrained")
        axes.plot(
            [r.x for r in finished], [factor * r.y for r in finished], "o-", color=BLUE, label="runs", linewidth=1.0
        )
        target = runs.y_text(runs.target_value)
        axes.axhline(factor * runs.target_value, color="#555555", linestyle="--", label=f"wanted: {target}")
        if search.best is not None:
            word = "found" if search.met else "nearest"
            label = f"{word}: {runs.x_text(search.best.x)}"
            axes.plot(search.best.x, factor * search.best.y, "D", color=RED, markersize=9, label=label)
        for k, run in enumerate(r for r in search.runs if r.reason):
            label = "failed run" if k == 0 else "_"
            axes.plot(run.x, 0.02, "|", color=RED, transform=axes.get_xaxis_transform(), label=label, markersize=10)
        if runs.parameter.log:
            axes.set_xscale("log")
        axes.set_xlabel(titled(runs.target.by, runs.parameter.unit))
        axes.set_ylabel(titled(runs.column, unit))
        axes.set_title(f"{runs.column} by {runs.target.by}, {len(search.runs)} runs")
        axes.legend()
    return figure
