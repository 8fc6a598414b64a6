"""A study on one slide: shares within limits or percentiles, and the measure that matters most."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from ali3.chart_style import BLUE
from hosts.run.slide import Draw, write_slide
from hosts.study.analysis.data import Response, StudyData
from hosts.study.analysis.indices import Indices
from hosts.study.analysis.summary_plots import plot_distribution, plot_indices, rank_correlations
from hosts.study.analysis.tables import statistics, told_statistics
from hosts.study.limits import Share, share_rows, shares


def write_study_slide(data: StudyData, indices: Indices | str | None, folder: Path) -> list[Path]:
    """Write ``summary.svg`` and ``summary.png``. `indices`: of `main_response`; a str says why there are none."""
    found = shares(data.frame)
    if found:
        head = ["measure", "limit", "within", "share", "95 %"]
        rows = limit_rows(found, data)
    else:
        told = told_statistics(data)[0] if data.responses else []
        names = ("5 %", "median", "95 %") if "5 %" in told else ("lowest", "median", "highest")
        head = ["measure", "unit", *names]
        rows = [_statistics(response, names) for response in data.responses]
    main, draws = main_response(data), list[Draw]()
    if main is not None:
        draws.append(lambda axes: plot_distribution(axes, data, main))
        if isinstance(indices, Indices):
            draws.append(lambda axes: plot_indices(axes, indices))
        if data.parameters:
            draws.append(lambda axes: _strongest(axes, data, main))
    subtitle = (
        f"{len(data.frame)} of {data.planned} runs, {int(data.failed.sum())} failed; sampling {data.method}; "
        f"{data.about['model']}, {', '.join(data.about['manoeuvres'])}"
    )
    return write_slide(folder / "summary", f"Study {data.about['study']}", subtitle, head, rows, draws)


def limit_rows(found: list[Share], data: StudyData) -> list[list[str]]:
    """A row for each limit, of all together first: a slide has no room for many."""
    rows = [[*row[:2], row[2].partition(",")[0].partition(";")[0], *row[3:]] for row in share_rows(found, data.about)]
    return [*rows[-1:], *rows[:-1]]


def main_response(data: StudyData) -> Response | None:
    """The measure of the slide's plots: the first with a limit that varies, else the first that varies."""
    varied = [r for r in data.responses if r.varies]
    limited = [r for r in varied if any(map(math.isfinite, r.limits))]
    return next(iter([*limited, *varied]), None)


def _statistics(response: Response, names: Sequence[str]) -> list[str]:
    found = statistics(response)
    unit = "" if response.unit == "1" else response.unit
    return [response.label, unit, *(f"{found[name]:.4g}" for name in names)]


def _strongest(axes: Axes, data: StudyData, response: Response) -> None:
    """The measure over the parameter that it goes with most."""
    strengths = np.nan_to_num(np.abs(rank_correlations(data, [response])[0]))
    k = int(np.argmax(strengths))
    parameter = data.parameters[k]
    axes.plot(data.x[response.rows, k], response.values, ".", color=BLUE, markersize=4, alpha=0.7)
    for end in filter(math.isfinite, response.limits):
        axes.axhline(end, color="#222222", linewidth=1.5)
    if parameter.log:
        axes.set_xscale("log")
    if parameter.words:
        axes.set_xticks(range(len(parameter.words)), parameter.words)
    axes.set_xlabel(parameter.title)
    axes.set_ylabel(response.unit if response.unit != "1" else "")
    axes.set_title(response.label)
