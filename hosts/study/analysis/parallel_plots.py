"""Parallel coordinates: a line a run, an axis a parameter."""

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
from hosts.study.analysis.effect_plots import WIDTH, drawn

MOST_LINES = 300
_TICKS = 5
_MOST_LEVELS = 6


def plot_parallel(data: StudyData, response: Response) -> Figure:
    """Parameters and, on the last axis, the measure, which is the colour too; failed runs are dotted and end before."""
    selected = drawn(len(response.rows), MOST_LINES)
    # Extreme runs lie on top of those of the middle.
    selected = selected[np.argsort(np.abs(response.values[selected] - np.median(response.values)), kind="stable")]
    values = response.values[selected]
    failed = data.failed_of(response)
    failed = failed[drawn(len(failed), MOST_LINES // 5)]

    heights, ticks = [], []
    for k, parameter in enumerate(data.parameters):
        scaled, marks = _axis(parameter, data.x[:, k])
        heights.append(scaled)
        ticks.append(marks)
    low, high = _range(response.values)
    last = (values - low) / (high - low)
    x = np.stack(heights, axis=1)
    figure, axes = plt.subplots(figsize=(WIDTH, 3.6), layout="constrained")
    colours = colormaps["viridis"](Normalize(low, high)(values))
    width = 0.6 if len(selected) > 100 else 1.0
    axes.add_collection(
        LineCollection(_lines(np.column_stack([x[response.rows[selected]], last])), colors=colours, linewidths=width)
    )
    if len(failed):
        axes.add_collection(
            LineCollection(_lines(x[failed]), colors=RED, linewidths=0.9, linestyles="dotted", zorder=3)
        )
    ticks.append([((v - low) / (high - low), _short(v)) for v in np.linspace(low, high, _TICKS)])
    _decorate(axes, [p.title for p in data.parameters] + [response.title], ticks)
    return figure


def _axis(parameter: Parameter, x: NDArray[np.float64]) -> tuple[NDArray[np.float64], list[tuple[float, str]]]:
    """Heights 0 to 1 of the values of a parameter, and of its ticks."""
    scaled = np.log(x) if parameter.log else x
    low, high = _range(scaled)
    if parameter.words:
        return (scaled - low) / (high - low), [((k - low) / (high - low), w) for k, w in enumerate(parameter.words)]
    levels = np.unique(scaled)
    marks = levels if len(levels) <= _MOST_LEVELS else np.linspace(low, high, _TICKS)
    values = np.exp(marks) if parameter.log else marks
    ticks = [((float(m) - low) / (high - low), _short(v)) for m, v in zip(marks, values, strict=True)]
    return (scaled - low) / (high - low), ticks


def _short(value: float) -> str:
    """Four digits, without an exponent where there is room."""
    return f"{value:.0f}" if 1e3 <= abs(value) < 1e6 else f"{value:.4g}"


def _range(values: NDArray[np.float64]) -> tuple[float, float]:
    low, high = float(values.min()), float(values.max())
    return (low, high) if high > low else (low - 0.5, high + 0.5)


def _lines(heights: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """Points (axes, 2) of each line."""
    across = np.broadcast_to(np.arange(heights.shape[1], dtype=float), heights.shape)
    return list(np.stack([across, heights], axis=2))


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
