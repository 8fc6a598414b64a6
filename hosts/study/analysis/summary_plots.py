"""Plots of a measure over all runs: distribution, indices, and rank correlations with the parameters."""

import math
from collections.abc import Sequence

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray
from scipy.stats import spearmanr

from ali3.chart_style import BLACK, BLUE, ORANGE, RED
from hosts.study.analysis.data import Response, StudyData
from hosts.study.analysis.effect_plots import WIDTH
from hosts.study.analysis.indices import Indices
from hosts.study.analysis.tables import reason_without_distribution

PERCENTILES = (5.0, 50.0, 95.0)
_MAX_BINS = 60


def plot_overview(data: StudyData, response: Response, indices: Indices | str) -> Figure:
    """The distribution of a measure, and beside it its indices, if there are any."""
    if isinstance(indices, str):
        figure, axes = plt.subplots(figsize=(0.55 * WIDTH, 2.9), layout="constrained")
        plot_distribution(axes, data, response)
        return figure
    height = max(2.9, 0.9 + 0.42 * len(indices.names))
    figure, (left, right) = plt.subplots(1, 2, figsize=(WIDTH, height), layout="constrained")
    plot_distribution(left, data, response)
    plot_indices(right, indices)
    return figure


def plot_distribution(axes: Axes, data: StudyData, response: Response) -> None:
    """Draw a histogram with percentiles, or the sorted values if there is no distribution, and the limits."""
    if reason := reason_without_distribution(data, response):
        axes.plot(np.sort(response.values), np.arange(1, len(response.values) + 1), "o", color=BLUE, markersize=4)
        axes.yaxis.set_major_locator(MaxNLocator(integer=True))
        axes.set_ylabel("runs, lowest first")
        axes.set_title(f"Values ({reason})")
    else:
        _histogram(axes, response.values)
    for limit in filter(math.isfinite, response.limits):
        axes.axvline(limit, color=BLACK, linewidth=2.0, label=f"limit: {limit:.6g}")
    if axes.get_legend_handles_labels()[0]:
        axes.legend(
            loc="lower right", bbox_to_anchor=(1.0, 0.985), ncols=3, handlelength=1.4, columnspacing=1.0, fontsize=8
        )
    axes.set_xlabel(response.title)
    axes.set_axisbelow(True)


def _histogram(axes: Axes, y: NDArray[np.float64]) -> None:
    edges = np.histogram_bin_edges(y, "auto")
    if len(edges) > _MAX_BINS + 1:
        edges = np.linspace(y.min(), y.max(), _MAX_BINS + 1)
    axes.hist(y, edges.tolist(), color=BLUE, alpha=0.75)
    for percent, value in zip(PERCENTILES, np.percentile(y, PERCENTILES), strict=True):
        dashes = "-" if percent == 50.0 else "--"
        axes.axvline(float(value), color=RED, linewidth=1.2, linestyle=dashes, label=f"{percent:g} %: {value:.4g}")
    axes.set_ylabel("runs")
    axes.set_title("Distribution")


def plot_indices(axes: Axes, indices: Indices) -> None:
    """Draw indices with their intervals, with hollow markers if the interval includes zero."""
    order = np.argsort(np.where(np.isnan(indices.total), indices.first, indices.total))
    at = np.arange(len(order), dtype=float)
    has_total = bool(np.isfinite(indices.total).any())
    for values, conf, label, colour, shift in (
        (indices.first, indices.first_conf, "first order", BLUE, 0.2 if has_total else 0.0),
        (indices.total, indices.total_conf, "total", ORANGE, -0.2),
    ):
        if np.isfinite(values).any():
            value, half = values[order], np.nan_to_num(conf[order])
            may_be_zero = (value - half <= 0.0) & (half > 0.0)
            for rows, fill, message in ((~may_be_zero, colour, label), (may_be_zero, "white", f"{label}, may be 0")):
                if rows.any():
                    axes.errorbar(
                        value[rows], at[rows] + shift, xerr=half[rows], fmt="o", color=colour, markerfacecolor=fill,
                        markersize=6, capsize=3, linewidth=1.2, label=message,
                    )  # fmt: skip
    axes.set_yticks(at, [indices.names[k] for k in order])
    axes.set_ylim(-0.6, len(order) - 0.4)
    axes.grid(visible=False, axis="y")
    axes.set_axisbelow(True)
    axes.axvline(0.0, color="#888888", linewidth=0.8)
    axes.set_xlim(min(0.0, axes.get_xlim()[0]), max(1.0, axes.get_xlim()[1]))
    axes.set_xlabel("part of the variance")
    axes.set_title("Sobol' indices")
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.985), ncols=2, fontsize=8, borderaxespad=0.1)


def rank_correlations(data: StudyData, responses: Sequence[Response]) -> NDArray[np.float64]:
    """Spearman's rank correlation of each measure with each parameter.

    Returns an array of shape (responses, parameters): -1 to 1; NaN where one of the two is constant, or the parameter
    has more than two categories.
    """
    table = np.full((len(responses), len(data.parameters)), np.nan)
    for i, response in enumerate(responses):
        for j, parameter in enumerate(data.parameters):
            x = data.x[response.rows, j]
            if len(parameter.categories) <= 2 and len(x) > 2 and np.ptp(x) > 0.0 and response.varies:
                table[i, j] = spearmanr(x, response.values).statistic
    return table


def plot_correlations(data: StudyData, responses: Sequence[Response]) -> Figure:
    """The rank correlations as a coloured table."""
    table = rank_correlations(data, responses)
    size = (min(WIDTH, 4.0 + 0.9 * table.shape[1]), 1.4 + 0.36 * table.shape[0])
    figure, axes = plt.subplots(figsize=size, layout="constrained")
    image = axes.imshow(table, vmin=-1.0, vmax=1.0, cmap="RdBu", aspect="auto")
    axes.set_xticks(range(table.shape[1]), [p.name for p in data.parameters], rotation=30, ha="right")
    axes.set_yticks(range(table.shape[0]), [r.label for r in responses])
    axes.grid(visible=False)
    for (i, j), value in np.ndenumerate(table):
        if np.isfinite(value):
            colour = "white" if abs(value) > 0.6 else "#222222"
            axes.text(j, i, f"{value:.2f}", ha="center", va="center", fontsize=8, color=colour)
    figure.colorbar(image, ax=axes, label="rank correlation", shrink=0.8)
    return figure
