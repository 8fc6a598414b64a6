"""The figure of a comparison: measured and simulated signals, residuals and inputs."""

import math
from collections.abc import Mapping
from typing import Any

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot as plt
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from ali3.chart_style import BLUE, COLOURS, RED, STYLE
from ali3.charts import MANY_POINTS
from hosts.common.display_units import number_in, shown_in, titled
from hosts.compare.comparison import Comparison
from hosts.experiment.line_simplification import thinned_indices
from hosts.measures.signal import Signal

_STYLE: dict[Any, Any] = {**STYLE, "font.size": 9, "axes.titlesize": 10, "legend.fontsize": 8, "lines.linewidth": 1.3}
_MEASURED = "#8a8a8a"
_MAX_SIGNALS = 12  # signals of a page
_MAX_POINTS = 4000


def comparison_figure(before: Comparison, after: Comparison | None, title: str, inputs: Mapping[str, Signal]) -> Figure:
    """The figure of a comparison: a row of two plots for each signal, and the inputs below.

    `before`: result with the parameters of the FMU; `after`: result with fitted ones.
    """
    names = list(before.signals)[:_MAX_SIGNALS]
    rows = len(names) + bool(inputs)
    height = 0.5 + 2.1 * rows
    with plt.rc_context(_STYLE):
        layout = ConstrainedLayoutEngine(rect=(0.0, 0.0, 1.0, 1.0 - 0.35 / height))
        figure = plt.figure(figsize=(13.0, height), layout=layout)
        figure.suptitle(title, x=0.01, y=1.0 - 0.08 / height, ha="left", va="top", fontsize=12, fontweight="bold")
        grid = figure.add_gridspec(rows, 2, width_ratios=(1.7, 1.0))
        shared_axis = None
        for k, name in enumerate(names):
            s = before.signals[name]
            indices = thinned_indices(s.measured.time, s.measured.values, _MAX_POINTS)
            unit, factor = shown_in(s.measured.unit, name)
            t, y = s.measured.time[indices], factor * s.measured.values[indices]
            signal_axes = figure.add_subplot(grid[k, 0], sharex=shared_axis)
            shared_axis = shared_axis or signal_axes
            residual_axes = figure.add_subplot(grid[k, 1], sharex=shared_axis)
            signal_axes.plot(
                t, y, ".", color=_MEASURED, markersize=2.5, label="measured", rasterized=len(t) > MANY_POINTS
            )
            runs = [(s, BLUE, "simulated" if after is None else "simulated before")]
            if after is not None and name in after.signals:
                runs.append((after.signals[name], RED, "fitted"))
            for run, colour, label in runs:
                x = factor * run.simulated(t)
                signal_axes.plot(t, x, color=colour, label=label)
                residual_axes.plot(t, x - y, color=colour, linewidth=0.9)
            last = runs[-1][0]
            signal_axes.set_title(titled(name, unit))
            rms = f"rms {number_in(factor * last.deviations.rms, unit, '.3g')}"
            rating = f"; rating {last.rating.overall:.2f}" if math.isfinite(last.rating.overall) else ""
            residual_axes.set_title(f"simulated − measured: {rms}{rating}")
            residual_axes.axhline(0.0, color="#444444", linewidth=0.8)
            signal_axes.margins(x=0)
            if k == 0:
                signal_axes.legend(ncols=3, loc="lower right", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.0)
            if k == rows - 1:
                signal_axes.set_xlabel("time, s")
                residual_axes.set_xlabel("time, s")
        if inputs:
            _plot_inputs(figure, grid, rows - 1, inputs, shared_axis)
    return figure


def _plot_inputs(figure: Figure, grid: Any, row: int, inputs: Mapping[str, Signal], shared_axis: Any) -> None:
    axes = figure.add_subplot(grid[row, :1], sharex=shared_axis)
    for k, (name, s) in enumerate(inputs.items()):
        unit, factor = shown_in(s.unit, name)
        axes.plot(s.time, factor * s.values, color=COLOURS[k % len(COLOURS)], label=titled(name, unit))
    axes.set_title("inputs, as measured")
    axes.set_xlabel("time, s")
    axes.margins(x=0)
    axes.legend(ncols=4, loc="lower right", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.0)
