"""One page of plots of a run. A car gets its own page, any other FMU its outputs by unit."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from numpy.typing import NDArray

from ali3.chart_style import COLOURS, STYLE
from ali3.charts import save_picture
from hosts.driving.result import Result
from hosts.run.car_page import car_page
from hosts.run.plot_panels import draw_lines, draw_table

_MAX_PANELS = 9


def plot_page(
    result: Result, file: Path, title: str, rows: Sequence[tuple[str, str]], gates: NDArray[np.float64] | None = None
) -> None:
    """Draw the page.

    `file`: PNG to be written; `rows`: summary shown beside the plots; `gates`: drawn into the path; first and last x,
    right and left y of each, m, shape (gates, 4).
    """
    with plt.rc_context(STYLE):
        if all(n in result for n in ("chassis.x", "chassis.y", "speed", "wheel_FL.Fz")):
            figure = car_page(result, rows, gates)
        else:
            figure = _plain_page(result, rows)
        figure.suptitle(title, x=0.012, y=0.988, ha="left", va="top", fontsize=15, fontweight="bold")
        save_picture(figure, file)


def _plain_page(result: Result, rows: Sequence[tuple[str, str]]) -> Figure:
    groups: dict[str, list[str]] = {}
    # Poses of bodies serve drawings and would fill the page.
    for name in [n for n in result.names if not n.startswith("body.")] or result.names:
        groups.setdefault(result.units[name], []).append(name)
    panels = [(unit, names[k : k + 5]) for unit, names in groups.items() for k in range(0, len(names), 5)][:_MAX_PANELS]
    columns = 3 if len(panels) + 1 > 4 else 2
    lines = -(-(len(panels) + 1) // columns)
    height = 1.2 + 3.3 * lines
    layout = ConstrainedLayoutEngine(rect=(0.005, 0.005, 0.99, 1.0 - 0.6 / height - 0.005), w_pad=0.1, h_pad=0.1)
    figure = plt.figure(figsize=(16, height), layout=layout)
    grid = figure.add_gridspec(lines, columns)
    first: Axes | None = None
    for k, (unit, names) in enumerate(panels):
        axes = figure.add_subplot(grid[k // columns, k % columns], sharex=first)
        first = first or axes
        series = [(n, result[n], COLOURS[j]) for j, n in enumerate(names)]
        draw_lines(axes, result.time, series, ", ".join(names) if len(", ".join(names)) < 46 else f"in {unit}", unit)
        axes.set_xlabel("time, s")
    draw_table(figure.add_subplot(grid[len(panels) // columns, len(panels) % columns]), rows)
    return figure
