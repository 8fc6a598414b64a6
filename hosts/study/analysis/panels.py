"""A figure with a panel for each parameter."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter
from numpy.typing import NDArray

from hosts.study.analysis.data import Parameter

WIDTH = 11.0
_COLUMNS = 4
_ROW = 2.5


def parameter_panels(parameters: Sequence[Parameter], label: str) -> tuple[Figure, list[Axes]]:
    """A figure with axes that are labelled, the vertical ones with `label`; these have one scale, to be compared."""
    columns = min(_COLUMNS, max(len(parameters), 2))
    rows = -(-len(parameters) // columns)
    figure, grid = plt.subplots(
        rows, columns, figsize=(WIDTH, 0.4 + _ROW * rows), sharey=True, squeeze=False, layout="constrained"
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
        if parameter.words:
            panel.set_xticks(range(len(parameter.words)), parameter.words)
        if k % columns == 0:
            panel.set_ylabel(_wrapped(label))
    return figure, axes[: len(parameters)]


def _wrapped(label: str) -> str:
    """A long name in lines that fit beside a panel."""
    return label if len(label) <= 28 else label.replace(" (", "\n(").replace(", ", ",\n")


def drawn(count: int, most: int) -> NDArray[np.int64]:
    """Positions of the runs that a plot shows: all, or so many at random."""
    if count <= most:
        return np.arange(count)
    return np.sort(np.random.default_rng(0).choice(count, most, replace=False))
