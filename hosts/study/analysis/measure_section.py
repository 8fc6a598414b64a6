"""The section of the report about one measure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ali3.charts import drawing
from ali3.html_elements import element, table
from hosts.common.display_units import number_in
from hosts.common.numbers import is_round_off
from hosts.experiment.report import FAINT, NOTE, Plots, Section, commands_cell, paragraph
from hosts.study.analysis.data import Parameter, Response, StudyData
from hosts.study.analysis.effect_plots import MAX_POINTS, plot_main_effects, plot_scatter
from hosts.study.analysis.indices import Indices, estimated_indices, grid_indices, saltelli_indices
from hosts.study.analysis.main_effects import MainEffect, main_effect
from hosts.study.analysis.parallel_plots import MAX_LINES, plot_parallel
from hosts.study.analysis.study_section import Commands
from hosts.study.analysis.summary_plots import plot_overview
from hosts.study.analysis.tables import Row, extremes, reason_without_distribution

if TYPE_CHECKING:
    from lxml.html import HtmlElement
    from matplotlib.figure import Figure

_MAX_EXTREMES = 5


def measure_section(
    data: StudyData, response: Response, number: int, plots: Plots, commands: Commands, numbers: list[dict[str, object]]
) -> Section:
    """The section of a measure: distribution, indices, main effects, runs, and the highest and lowest runs.

    `number`: number of the response, for the names of its plots; `commands`: commands that repeat a run; `numbers`:
    rows of the table of effects, to which one for each parameter is added.
    """
    if not response.varies:
        value = number_in(float(response.values.min()), response.unit, ".6g")
        message = f"It is {value} in all runs, but for rounding: nothing that was varied changes it."
        if len(response.values) == 1:
            message = f"One run yields it: {value}."
        return Section(response.title, [paragraph(message, NOTE)])
    effects = [main_effect(data.x[response.rows, k], response.values) for k in range(len(data.parameters))]
    indices = indices_of(data, response)
    numbers += _effect_rows(response, data.parameters, effects, indices)
    has_failed, label = bool(data.failed.any()), response.label

    def plot(figure: Figure, name: str, message: str) -> HtmlElement:
        return plots.add(drawing(figure, message), f"{number + 1:02d}_{name}_{label}")

    message = f"{'Values' if reason_without_distribution(data, response) else 'Distribution'} of {label}"
    body = [plot(plot_overview(data, response, indices), "overview", message)]
    body.append(paragraph(indices if isinstance(indices, str) else indices.how, FAINT))
    if data.parameters:
        body.append(element("h3", "Main effects"))
        body.append(plot(plot_main_effects(data.parameters, response, effects), "effects", f"Main effects on {label}"))
        of_blocks = " (about: runs of a block of the design share values)" * (data.method == "saltelli")
        message = f"Mean over all runs of a class of the parameter, with its interval of 95 %{of_blocks}."
        body.append(paragraph(message, FAINT))
        body.append(element("h3", "Runs"))
        body.append(plot(plot_scatter(data, response, effects), "runs", f"{label} over each parameter"))
        body.append(
            _count_note("run", len(response.rows), MAX_POINTS, "; red marks below are failed runs" * has_failed)
        )
        body.append(plot(plot_parallel(data, response), "parallel", f"Parallel coordinates of {label}"))
        body.append(
            _count_note("line", len(response.rows), MAX_LINES, "; dotted red lines are failed runs" * has_failed)
        )
    highest, lowest = extremes(data, response, _MAX_EXTREMES)
    body.append(element("h3", "Highest and lowest"))
    body.append(_extremes_table(data, response, [*highest, *reversed(lowest)], commands))
    return Section(response.title, body)


def _count_note(noun: str, count: int, most: int, suffix: str) -> HtmlElement:
    message = f"{most} of {count} {noun}s, drawn at random" if count > most else f"All {count} {noun}s"
    return paragraph(f"{message}{suffix}.", FAINT)


def _extremes_table(data: StudyData, response: Response, rows: Sequence[Row], commands: Commands) -> HtmlElement:
    table_rows = []
    for row in rows:
        values = [
            p.categories[int(v)] if p.categories else f"{v:.6g}"
            for p, v in zip(data.parameters, data.x[row.position], strict=True)
        ]
        table_rows.append((str(row.index), f"{row.value:.6g}", *values, commands_cell(commands(row.index))))
    head = ("run", response.title, *(p.title for p in data.parameters), "to repeat it")
    return table(f"Highest runs of {response.title}, then lowest", head, table_rows, "numbers")


def indices_of(data: StudyData, response: Response) -> Indices | str:
    """Sobol' indices of a measure by the estimator for the design, or a sentence why there are none."""
    names = [p.name for p in data.parameters]
    if not names:
        return "The study has no parameters."
    if len(names) == 1:
        return f"No indices: {names[0]} alone is varied and makes all of the variance."
    if data.method == "saltelli":
        return saltelli_indices(names, data.points(response), response.values)
    x = data.x[response.rows]
    if data.method == "grid":
        return grid_indices(names, x, response.values)
    if data.method == "table":
        return "No indices: they need a random design or a full grid; how the rows of a table were chosen is unknown."
    ordered = [k for k, p in enumerate(data.parameters) if len(p.categories) <= 2]
    result = estimated_indices([names[k] for k in ordered], x[:, ordered], response.values)
    unordered = [p.name for p in data.parameters if len(p.categories) > 2]
    if unordered and isinstance(result, Indices):
        result = replace(result, how=f"{result.how} Without {', '.join(unordered)}, whose values have no order.")
    return result


def _effect_rows(
    response: Response, parameters: Sequence[Parameter], effects: Sequence[MainEffect], indices: Indices | str
) -> list[dict[str, object]]:
    rows = []
    for parameter, effect in zip(parameters, effects, strict=True):
        row: dict[str, object] = {"measure": response.measure, "manoeuvre": response.manoeuvre, "unit": response.unit}
        span = 0.0 if is_round_off(effect.span, float(np.abs(response.values).max())) else effect.span
        row |= {"parameter": parameter.name, "parameter_unit": parameter.unit, "main_effect_span": span}
        if isinstance(indices, Indices) and parameter.name in indices.names:
            k = indices.names.index(parameter.name)
            row |= {"first": indices.first[k], "first_conf": indices.first_conf[k]}
            row |= {"total": indices.total[k], "total_conf": indices.total_conf[k]}
        rows.append(row)
    return rows
