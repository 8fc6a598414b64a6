"""Plots of a test as SVG, with the lines of several cars in one plot."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from ali3.chart_style import COLOURS, STYLE
from ali3.charts import Drawing, drawing
from hosts.catalogue.report.numbers import number_text
from hosts.catalogue.standard_test import Line, Plot
from hosts.common.display_units import axis_shown
from hosts.experiment.report import thinned_indices

_DASHES: tuple[Any, ...] = ("-", (0, (5, 2)), (0, (1, 1.4)), (0, (6, 2, 1, 2)), (0, (9, 3)), (0, (3, 1, 1, 1, 1, 1)))
_WIDTHS = (1.5, 1.9, 2.2, 1.7, 1.3, 1.7)
_MARKERS = ("", "o", "s", "^", "D", "v", "P")
_COMMON = "#767676"
_MARKERS_OF_LINE = 9
"""Number of markers on a line that is one of several of its car."""
# Inches; height of the axes.
_WIDTH = 5.625
_HEIGHT = 2.9
_LEFT = 0.85
_RIGHT = 0.15
_ABOVE = 0.32
_BELOW = 0.55
_LEGEND_ROW = 0.21
_FEW_POINTS = 40
"""Largest number of points that are marked individually."""
_SETTINGS: Mapping[Any, Any] = {**STYLE, "axes.titlesize": 10.5}


def drawings_of(plots_by_car: Mapping[str, Sequence[Plot]]) -> dict[str, Drawing]:
    """All plots of a test by their titles.

    `plots_by_car`: plots by label of the car, in the order of the cars; plots of one title are one drawing.
    """
    by_title: dict[str, dict[int, tuple[str, Plot]]] = {}
    for k, (label, plots) in enumerate(plots_by_car.items()):
        for plot in plots:
            by_title.setdefault(plot.title, {})[k] = (label, plot)
    with matplotlib.rc_context(dict(_SETTINGS)):
        return {title: _draw_picture(title, plots, len(plots_by_car) > 1) for title, plots in by_title.items()}


def _draw_picture(title: str, plots: Mapping[int, tuple[str, Plot]], many: bool) -> Drawing:
    plots = {k: (label, _in_display_units(plot)) for k, (label, plot) in plots.items()}
    first = next(iter(plots.values()))[1]
    shared = _shared_lines([plot for _, plot in plots.values()])
    names = [
        *shared,
        *(_legend_text(n, line, p, many) for n, p in plots.values() for line in p.lines if line.label not in shared),
    ]
    columns = 1 if max(map(len, names), default=0) > 30 else 2
    rows = -(-len(names) // columns) if len(names) > 1 else 0
    below = _BELOW + _LEGEND_ROW * rows
    height = _ABOVE + _HEIGHT * (1.3 if first.equal else 1.0) + below
    figure = Figure(figsize=(_WIDTH, height))
    # Fixed margins: computing a layout takes longer than drawing.
    figure.subplots_adjust(_LEFT / _WIDTH, below / height, 1.0 - _RIGHT / _WIDTH, 1.0 - _ABOVE / height)
    axes = figure.add_subplot()
    descriptions = _draw_plots(axes, plots, shared, many)
    axes.set_title(title)
    if rows:
        figure.legend(
            loc="lower left", bbox_to_anchor=(0.05 / _WIDTH, 0.0), borderaxespad=0.2, ncols=columns, handlelength=3.4
        )
    return drawing(figure, f"{title}: {first.y} over {first.x}. {'; '.join(descriptions) or 'No lines'}.")


def _draw_plots(axes: Axes, plots: Mapping[int, tuple[str, Plot]], shared: Mapping[str, Line], many: bool) -> list[str]:
    """Draw lines, labels and scales of a plot. Returns a description of each line."""
    first = next(iter(plots.values()))[1]
    descriptions = []
    for line in shared.values():
        axes.plot(line.x, line.y, color=_COMMON, linewidth=1.2, label=line.label)
        descriptions.append(f"{line.label}: {_line_description(line)}")
    for k, (label, plot) in plots.items():
        for j, line in enumerate(line for line in plot.lines if line.label not in shared):
            name = _legend_text(label, line, plot, many)
            _draw_line(axes, line, name, *((k, j) if many else (j, 0)))
            descriptions.append(f"{name or 'the line'}: {_line_description(line)}")
    for log, axis, set_scale in (
        (first.log_x, axes.xaxis, axes.set_xscale),
        (first.log_y, axes.yaxis, axes.set_yscale),
    ):
        if log:
            set_scale("log")
            axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axis.set_minor_formatter(FuncFormatter(_two_or_five))
    if first.equal:
        axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel(first.x)
    axes.set_ylabel(first.y)
    return descriptions


def _in_display_units(plot: Plot) -> Plot:
    """The plot in the units in which reports show its axes."""
    (x, x_factor), (y, y_factor) = axis_shown(plot.x), axis_shown(plot.y)
    if x_factor == y_factor == 1.0:
        return plot
    lines = [Line(line.label, x_factor * np.asarray(line.x), y_factor * np.asarray(line.y)) for line in plot.lines]
    return replace(plot, x=x, y=y, lines=lines)


def _shared_lines(plots: Sequence[Plot]) -> dict[str, Line]:
    """Lines by label that are equal for all cars, such as lanes; none if all lines are equal."""
    if len(plots) < 2:
        return {}
    shared = {
        line.label: line
        for line in plots[0].lines
        if line.label and all(any(_are_equal(line, other) for other in plot.lines) for plot in plots[1:])
    }
    return shared if len(shared) < len(plots[0].lines) else {}


def _are_equal(one: Line, other: Line) -> bool:
    return (
        one.label == other.label
        and np.array_equal(one.x, other.x, equal_nan=True)
        and np.array_equal(one.y, other.y, equal_nan=True)
    )


def _two_or_five(value: float, _: object) -> str:
    return f"{value:g}" if f"{value:e}"[0] in "25" else ""


def _legend_text(label: str, line: Line, plot: Plot, many: bool) -> str:
    if not many:
        return line.label
    return label if len(plot.lines) == 1 or not line.label or line.label == label else f"{label}, {line.label}"


def _draw_line(axes: Axes, line: Line, name: str, style: int, marker_number: int) -> None:
    """Draw a line. `style`: index of colour and dashes, which differ also in grey."""
    x, y = (np.atleast_1d(np.asarray(v, np.float64)) for v in (line.x, line.y))
    indices = thinned_indices(x, y)
    x, y = x[indices], y[indices]
    marker = _MARKERS[marker_number % len(_MARKERS)] or ("." if 0 < len(x) <= _FEW_POINTS else "")
    axes.plot(
        x,
        y,
        color=COLOURS[style % len(COLOURS)],
        linestyle=_DASHES[style % len(_DASHES)],
        linewidth=_WIDTHS[style % len(_WIDTHS)],
        marker=marker or None,
        markersize=4.5,
        markevery=max(1, len(x) // _MARKERS_OF_LINE) if len(x) > _FEW_POINTS else 1,
        label=name or None,
    )


def _line_description(line: Line) -> str:
    finite = np.isfinite(line.x) & np.isfinite(line.y)
    if not finite.any():
        return "no points"
    x, y = np.asarray(line.x)[finite], np.asarray(line.y)[finite]
    top, low = int(np.argmax(y)), int(np.argmin(y))
    return (
        f"from {number_text(y[0])} at {number_text(x[0])} to {number_text(y[-1])} at {number_text(x[-1])}, "
        f"largest {number_text(y[top])} at {number_text(x[top])}, "
        f"smallest {number_text(y[low])} at {number_text(x[low])}"
    )
