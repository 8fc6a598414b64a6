"""Plots of parallel coordinates: a line for each run, an axis for each parameter."""

from collections.abc import Sequence

import numpy as np
from matplotlib import colormaps
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ali3.chart_style import RED
from hosts.study.analysis.data import Parameter, Response, StudyData
from hosts.study.analysis.effect_plots import WIDTH, random_subset

MAX_LINES = 300
_TICKS = 5
_MAX_LEVELS = 6


def plot_parallel(data: StudyData, response: Response) -> Figure:
    """Parallel coordinates with the measure on the last axis and as colour; failed runs, without it, are dotted."""
    selected = random_subset(len(response.rows), MAX_LINES)
    # Lines of extreme runs are drawn last.
    selected = selected[np.argsort(np.abs(response.values[selected] - np.median(response.values)), kind="stable")]
    values = response.values[selected]
    failed = data.failed_of(response)
    failed = failed[random_subset(len(failed), MAX_LINES // 5)]

    heights, ticks = [], []
    for k, parameter in enumerate(data.parameters):
        axis_heights, axis_ticks = _scaled_axis(parameter, data.x[:, k])
        heights.append(axis_heights)
        ticks.append(axis_ticks)
    low, high = _range(response.values)
    last = (values - low) / (high - low)
    x = np.stack(heights, axis=1)
    figure, axes = plt.subplots(figsize=(WIDTH, 3.6), layout="constrained")
    colours = colormaps["viridis"](Normalize(low, high)(values))
    width = 0.6 if len(selected) > 100 else 1.0
    axes.add_collection(
        LineCollection(
            _polylines(np.column_stack([x[response.rows[selected]], last])), colors=colours, linewidths=width
        )
    )
    if len(failed):
        axes.add_collection(
            LineCollection(_polylines(x[failed]), colors=RED, linewidths=0.9, linestyles="dotted", zorder=3)
        )
    ticks.append([((v - low) / (high - low), _tick_text(v)) for v in np.linspace(low, high, _TICKS)])
    _decorate(axes, [p.title for p in data.parameters] + [response.title], ticks)
    return figure


def _scaled_axis(parameter: Parameter, x: NDArray[np.float64]) -> tuple[NDArray[np.float64], list[tuple[float, str]]]:
    """Values of a parameter scaled to 0 to 1, and its ticks as positions with texts."""
    scaled = np.log(x) if parameter.log else x
    low, high = _range(scaled)
    if parameter.categories:
        return (scaled - low) / (high - low), [
            ((k - low) / (high - low), w) for k, w in enumerate(parameter.categories)
        ]
    levels = np.unique(scaled)
    marks = levels if len(levels) <= _MAX_LEVELS else np.linspace(low, high, _TICKS)
    values = np.exp(marks) if parameter.log else marks
    ticks = [((float(m) - low) / (high - low), _tick_text(v)) for m, v in zip(marks, values, strict=True)]
    return (scaled - low) / (high - low), ticks


def _tick_text(value: float) -> str:
    """A number with four digits, without an exponent below 1e6."""
    return f"{value:.0f}" if 1e3 <= abs(value) < 1e6 else f"{value:.4g}"


def _range(values: NDArray[np.float64]) -> tuple[float, float]:
    low, high = float(values.min()), float(values.max())
    return (low, high) if high > low else (low - 0.5, high + 0.5)


def _polylines(heights: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """Points of each line, shape (axes, 2). `heights`: shape (lines, axes)."""
    columns = np.broadcast_to(np.arange(heights.shape[1], dtype=float), heights.shape)
    return list(np.stack([columns, heights], axis=2))


def _decorate(axes: Axes, titles: Sequence[str], ticks: Sequence[Sequence[tuple[float, str]]]) -> None:
    axes.grid(visible=False)
    axes.set_yticks([])
    for side in ("left", "bottom"):
        axes.spines[side].set_visible(False)
    for k, marks in enumerate(ticks):
        axes.axvline(k, color="#555555", linewidth=1.0)
        for height, text in marks:
            axes.annotate(
                text, (k, height), xytext=(4, 0), textcoords="offset points", fontsize=7, va="center",
                bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.7, "pad": 0.5}, zorder=5,
            )  # fmt: skip
    axes.set_xlim(-0.1, len(titles) - 0.6)
    axes.set_ylim(-0.03, 1.03)
    axes.set_xticks(range(len(titles)), [t.replace(", ", "\n") for t in titles], fontsize=8)
    axes.tick_params(axis="x", length=0)
