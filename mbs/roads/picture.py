"""Picture of a road: heights and frictions from above, and longitudinal sections."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ali3.chart_description import save_figure
from mbs.elements.road import GridRoad, KerbRoad, PlaneRoad

HALF_LENGTH = 20.0
"""Drawn length to each side of the origin of a plane or of a kerb, m."""
LABEL = {"facecolor": "white", "alpha": 0.8, "linewidth": 0.0, "pad": 0.5}
MAX_POINTS = 2000
"""Largest number of drawn points along a side of a grid."""


def draw_road(
    road: PlaneRoad | KerbRoad | GridRoad, file: Path, name: str, starts: Mapping[str, tuple[float, float]]
) -> None:
    """Draw heights and frictions from above, x to the right and y up, and heights along three lines.

    `file`: a PNG, or what Matplotlib writes by the suffix; `starts`: start positions of a car, x and y by name, m.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    x, y, heights, frictions = drawn_values(road)
    figure = Figure(figsize=(10.0, 7.5), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(3, 1, sharex=True)
    for ax, values, label in ((axes[0], heights, "height, m"), (axes[1], frictions, "friction")):
        image = ax.pcolormesh(x, y, values.T, shading="gouraud", cmap="viridis")
        figure.colorbar(image, ax=ax, label=label)
        ax.set_ylabel("y, m (left)")
        for position in starts.values():
            ax.plot(*position, "r+", markersize=10, markeredgewidth=2)
    for start_name, position in starts.items():
        axes[0].annotate(start_name, position, (4.0, 4.0), textcoords="offset points", fontsize=7, bbox=LABEL)
    for k, style in ((0, ":"), (len(y) // 2, "-"), (len(y) - 1, "--")):
        axes[2].plot(x, heights[:, k], style, color="k", linewidth=1.0, label=f"y = {y[k]:.4g} m")
    axes[2].set_xlabel("x, m (ahead); + is where a car starts")
    axes[2].set_ylabel("height, m")
    axes[2].legend(loc="upper right", fontsize="small")
    axes[2].grid(True, alpha=0.3)
    figure.suptitle(f"{name} (beyond its border the values continue)" if isinstance(road, GridRoad) else name)
    save_figure(figure, file)


def drawn_values(
    road: PlaneRoad | KerbRoad | GridRoad,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Coordinates x (nx,) and y (ny,), heights and frictions (nx, ny) to draw; a large grid is thinned."""
    if isinstance(road, GridRoad):
        heights = np.asarray(road.heights, float)
        frictions = np.broadcast_to(np.asarray(road.frictions, float) * road.friction_factor, heights.shape)
        strides = tuple(slice(None, None, -(-n // MAX_POINTS)) for n in heights.shape)
        x, y = (
            np.asarray(road.origin[k] + road.spacing[k] * np.arange(heights.shape[k]), np.float64) for k in range(2)
        )
        return x[strides[0]], y[strides[1]], np.asarray(heights[strides]), frictions[strides]
    middle = road.position if isinstance(road, KerbRoad) else 0.0
    x = middle + np.linspace(-HALF_LENGTH, HALF_LENGTH, 401)
    y = np.linspace(-HALF_LENGTH / 4.0, HALF_LENGTH / 4.0, 51)
    if isinstance(road, PlaneRoad):
        heights = road.height + road.grade_x * x[:, None] + road.grade_y * y[None, :]
    else:
        upper = (x <= road.position) == (road.upper == "before")
        heights = np.repeat((road.lower_height + road.step * upper)[:, None], len(y), axis=1)
    return x, y, heights, np.full(heights.shape, road.friction * road.friction_factor)
