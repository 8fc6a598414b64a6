"""Plots over each parameter: main effects, runs, and the fraction of failed runs."""

from collections.abc import Sequence

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter
from numpy.typing import NDArray

from ali3.chart_style import BLUE, RED
from ali3.charts import MANY_POINTS
from hosts.study.analysis.data import Parameter, Response, StudyData
from hosts.study.analysis.main_effects import MainEffect, failed_share

WIDTH = 11.0
_COLUMNS = 4
_ROW_HEIGHT = 2.5


def parameter_panels(parameters: Sequence[Parameter], label: str) -> tuple[Figure, list[Axes]]:
    """A figure with axes for each parameter; their vertical axes have one scale and the given label."""
    columns = min(_COLUMNS, max(len(parameters), 2))
    rows = -(-len(parameters) // columns)
    figure, grid = plt.subplots(
        rows, columns, figsize=(WIDTH, 0.4 + _ROW_HEIGHT * rows), sharey=True, squeeze=False, layout="constrained"
    )
    axes = list(grid.flat)
    for panel in axes[len(parameters) :]:
        panel.axis("off")
    for k, (panel, parameter) in enumerate(zip(axes, parameters, strict=False)):
        panel.set_xlabel(parameter.title)
        if parameter.log:
            panel.set_xscale("log")
            panel.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            panel.xaxis.set_major_formatter("{x:g}")
            panel.xaxis.set_minor_formatter(NullFormatter())
        if parameter.categories:
            panel.set_xticks(range(len(parameter.categories)), parameter.categories)
        if k % columns == 0:
            panel.set_ylabel(_wrap(label))
    return figure, axes[: len(parameters)]


def _wrap(label: str) -> str:
    """A long label in several lines."""
    return label if len(label) <= 28 else label.replace(" (", "\n(").replace(", ", ",\n")


def random_subset(count: int, most: int) -> NDArray[np.int64]:
    """Positions of all `count` runs of a plot, or of a random subset of `most`."""
    if count <= most:
        return np.arange(count)
    return np.sort(np.random.default_rng(0).choice(count, most, replace=False))


MAX_POINTS = 2000


def plot_main_effects(parameters: Sequence[Parameter], response: Response, effects: Sequence[MainEffect]) -> Figure:
    """Means over each parameter with their intervals, on one scale."""
    figure, axes = parameter_panels(parameters, f"mean of {response.title}")
    for panel, parameter, effect in zip(axes, parameters, effects, strict=True):
        panel.axhline(float(response.values.mean()), color="#888888", linewidth=0.8)
        _plot_interval(panel, parameter, effect, BLUE)
    return figure


def plot_scatter(data: StudyData, response: Response, effects: Sequence[MainEffect]) -> Figure:
    """The measure of each run over each parameter, means as lines, and failed runs as marks at the lower edge."""
    figure, axes = parameter_panels(data.parameters, response.title)
    selected = random_subset(len(response.rows), MAX_POINTS)
    # Markers of few runs are large, of many runs small and transparent.
    size = float(np.clip(60.0 / len(selected) ** 0.4, 3.0, 10.0))
    alpha = float(np.clip(12.0 / len(selected) ** 0.45, 0.4, 0.9))
    failed = data.failed_of(response)
    failed = failed[random_subset(len(failed), MAX_POINTS)]
    for k, (panel, effect) in enumerate(zip(axes, effects, strict=True)):
        x = data.x[response.rows[selected], k]
        (points,) = panel.plot(
            x, response.values[selected], ".", color=BLUE, markersize=size, alpha=alpha, markeredgewidth=0
        )
        points.set_rasterized(len(x) > MANY_POINTS)
        mark = "_" if data.parameters[k].categories else "-"
        panel.plot(effect.at, effect.mean, mark, color="#222222", linewidth=1.2, markersize=14)
        if len(failed):
            panel.plot(
                data.x[failed, k], np.full(len(failed), 0.02), "|", color=RED, transform=panel.get_xaxis_transform()
            )
    return figure


def plot_failed(data: StudyData) -> Figure:
    """The fraction of failed runs over each parameter with Wilson's interval of 95 %, and the runs as marks."""
    figure, axes = parameter_panels(data.parameters, "failed runs, %")
    for k, panel in enumerate(axes):
        _plot_interval(panel, data.parameters[k], failed_share(data.x[:, k], data.failed), RED, 100.0)
        rows = np.flatnonzero(data.failed)
        rows = rows[random_subset(len(rows), MAX_POINTS)]
        panel.plot(data.x[rows, k], np.full(len(rows), 0.02), "|", color=RED, transform=panel.get_xaxis_transform())
    axes[0].set_ylim(bottom=-5.0)
    return figure


def _plot_interval(panel: Axes, parameter: Parameter, effect: MainEffect, colour: str, factor: float = 1.0) -> None:
    """Draw a line with its band, or points with error bars if the parameter is not a number."""
    at, mean, low, high = effect.at, *(factor * part for part in (effect.mean, effect.low, effect.high))
    if parameter.categories:
        panel.errorbar(at, mean, np.stack([mean - low, high - mean]), fmt="o", color=colour, markersize=4)
        panel.margins(x=0.2)
        return
    panel.fill_between(at, low, high, color=colour, alpha=0.2, linewidth=0)
    panel.plot(at, mean, "o-", color=colour, markersize=4)
