"""The report of a comparison: one page of HTML, and its figure of signals, residuals and inputs."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from ali3.chart_style import BLUE, COLOURS, RED, STYLE
from ali3.charts import MANY_POINTS, Drawing
from ali3.files import write_text
from ali3.html_elements import element, picture, table
from ali3.message_text import sentence_of
from ali3.units import typeset
from hosts.common.display_units import number_in, shown_in, titled
from hosts.compare.comparison import ComparedSignal, Comparison
from hosts.compare.comparison_text import delay_sentence, signal_rows
from hosts.compare.fit_result import Fit
from hosts.compare.fit_text import FIT_COLUMNS, fit_rows, result_text
from hosts.compare.windows import Bin
from hosts.experiment.report import NOTE, PROBLEM, Section, page, paragraph, thinned_indices
from hosts.measures.signal import Signal

if TYPE_CHECKING:
    from lxml.html import HtmlElement

_COLUMNS = ("signal", "unit", "rms", "normalised", "mean", "largest", "at, s", "correlation", "rating",
            "corridor", "phase", "magnitude", "slope", "delay, ms")  # fmt: skip
_BIN_COLUMNS = ("signal", "unit", "where", "from, to", "samples", "rms", "mean")
_FOOTER = (
    "Deviations are simulated minus measured, at the samples of the log, with no delay taken out. Normalised: rms over "
    "the standard deviation of the measured signal. The rating is like ISO/TS 18571, by public descriptions of it, at "
    "no more than 1000 points; above 0.94 excellent, 0.80 good, 0.58 fair. Intervals are of 95 %; they take into "
    "account that neighbouring residuals are alike, and hold as far as the model can be right at all. Without it: how "
    "much more is left of parts of the log that are left out in turn if the parameter keeps its start value."
)
_STYLE: dict[Any, Any] = {**STYLE, "font.size": 9, "axes.titlesize": 10, "legend.fontsize": 8, "lines.linewidth": 1.3}
_MEASURED = "#8a8a8a"
_MAX_SIGNALS = 12  # signals of a page
_MAX_POINTS = 4000


def write_report(
    title: str,
    before: Comparison,
    after: Comparison | None,
    fit: Fit | None,
    bins: Sequence[Bin],
    notes: Sequence[str],
    problems: Sequence[str],
    paths: Mapping[str, Path],
    figure: Drawing,
) -> None:
    """Write the page to the path ``.html``, and its figure to the path ``.svg``.

    `bins`: deviations by measured speed and lateral acceleration.
    """
    delay = delay_sentence(before)
    content: list[HtmlElement] = [_deviations_table(before)] + ([paragraph(delay)] if delay else [])
    sections = [Section("Deviations" if after is None else "Deviations before the fit", content)]
    if after is not None and fit is not None:
        sections.append(Section("Deviations with the fitted parameters and sensors", [_deviations_table(after)]))
        names = [f.unknown.name for f in fit.found]
        rows = [(n, *(f"{c:.2f}" for c in row)) for n, row in zip(names, fit.correlation.tolist(), strict=True)]
        content = [table("", FIT_COLUMNS, fit_rows(fit), "numbers")]
        content += [paragraph(sentence_of(line)) for line in result_text(fit)]
        content += [element("h3", "Correlation of the errors"), table("", ("", *names), rows, "numbers")]
        sections.append(Section("Fit", content))
    if bins:
        binned = table("", _BIN_COLUMNS, bin_rows(bins, before), "numbers")
        sections.append(Section("By speed and lateral acceleration", [binned]))
    figure.write(paths[".svg"])
    sections.append(Section("Signals", [picture(figure), *(paragraph(line, NOTE) for line in notes)]))
    facts = [paragraph(line, PROBLEM) for line in problems]
    write_text(paths[".html"], page(title, facts, sections, _FOOTER))


def bin_rows(bins: Sequence[Bin], comparison: Comparison) -> list[Sequence[str]]:
    """Rows of the table by speed and lateral acceleration, in the units of reports."""
    rows: list[Sequence[str]] = []
    for b in bins:
        unit, factor = shown_in(comparison.signals[b.signal].measured.unit, b.signal)
        scale, width = shown_in(b.unit)
        rows.append(
            [b.signal, typeset(unit), f"{b.quantity}, {typeset(scale)}", f"{width * b.low:g} to {width * b.high:g}",
             str(b.samples), f"{factor * b.rms:.4g}", f"{factor * b.mean:.4g}"]
        )  # fmt: skip
    return rows


def _deviations_table(comparison: Comparison) -> HtmlElement:
    rows = [[row[name] for name in _COLUMNS] for row in signal_rows(comparison, "–")]
    return table("", _COLUMNS, rows, "numbers")


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
            signal_axes = figure.add_subplot(grid[k, 0], sharex=shared_axis)
            shared_axis = shared_axis or signal_axes
            residual_axes = figure.add_subplot(grid[k, 1], sharex=shared_axis)
            fitted = None if after is None else after.signals.get(name)
            _plot_signal(
                signal_axes, residual_axes, before.signals[name], fitted, "simulated before" if after else "simulated"
            )
            if k == 0:
                signal_axes.legend(ncols=3, loc="lower right", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.0)
            if k == rows - 1:
                signal_axes.set_xlabel("time, s")
                residual_axes.set_xlabel("time, s")
        if inputs:
            _plot_inputs(figure, grid, rows - 1, inputs, shared_axis)
    return figure


def _plot_signal(
    signal_axes: Axes, residual_axes: Axes, before: ComparedSignal, fitted: ComparedSignal | None, label: str
) -> None:
    """Plot a signal, measured and simulated, and its residuals. `label`: legend of the run before the fit."""
    measured = before.measured
    indices = thinned_indices(measured.time, measured.values, _MAX_POINTS)
    unit, factor = shown_in(measured.unit, measured.name)
    t, y = measured.time[indices], factor * measured.values[indices]
    signal_axes.plot(t, y, ".", color=_MEASURED, markersize=2.5, label="measured", rasterized=len(t) > MANY_POINTS)
    for run, colour, text in ((before, BLUE, label), *([(fitted, RED, "fitted")] if fitted else [])):
        x = factor * run.simulated(t)
        signal_axes.plot(t, x, color=colour, label=text)
        residual_axes.plot(t, x - y, color=colour, linewidth=0.9)
    last = fitted or before
    signal_axes.set_title(titled(measured.name, unit))
    rms = f"rms {number_in(factor * last.deviations.rms, unit, '.3g')}"
    rating = f"; rating {last.rating.overall:.2f}" if math.isfinite(last.rating.overall) else ""
    residual_axes.set_title(f"simulated − measured: {rms}{rating}")
    residual_axes.axhline(0.0, color="#444444", linewidth=0.8)
    signal_axes.margins(x=0)


def _plot_inputs(figure: Figure, grid: Any, row: int, inputs: Mapping[str, Signal], shared_axis: Any) -> None:
    axes = figure.add_subplot(grid[row, :1], sharex=shared_axis)
    for k, (name, s) in enumerate(inputs.items()):
        unit, factor = shown_in(s.unit, name)
        axes.plot(s.time, factor * s.values, color=COLOURS[k % len(COLOURS)], label=titled(name, unit))
    axes.set_title("inputs, as measured")
    axes.set_xlabel("time, s")
    axes.margins(x=0)
    axes.legend(ncols=4, loc="lower right", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.0)
