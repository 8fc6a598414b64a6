"""The page of plots of a car: its path from above, and its usual signals over time."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.patches import Rectangle
from numpy.typing import NDArray

from ali3.chart_style import BLUE, GREEN, ORANGE, RED, SKY
from hosts.common.wheels import WHEELS
from hosts.driving.result import Result
from hosts.run.plot_panels import draw_lines, draw_table

_STANDING = 0.5  # m/s: below it a car has no direction of travel
_MAX_DOTS = 20  # of a path
_MIN_WIDTH = 4.0  # m, of a path
_MIN_SLENDERNESS = 0.02
_MAX_SLENDERNESS = 0.12
"""`_MIN_SLENDERNESS`, `_MAX_SLENDERNESS`: range of the height over the width of a path whose y is stretched."""


@dataclass(frozen=True)
class _Panel:
    """A plot over time: its lines by label, variable and colour, and the smallest span of its axis, in `unit`."""

    title: str
    unit: str
    lines: tuple[tuple[str, str, str], ...]
    factor: float = 1.0
    smallest_span: float = 0.0


def _wheels(quantity: str) -> tuple[tuple[str, str, str], ...]:
    colours = (BLUE, SKY, RED, ORANGE)
    return tuple((w, f"wheel_{w}.{quantity}", c) for w, c in zip(WHEELS, colours, strict=True))


def _gauges(quantity: str) -> tuple[tuple[str, str, str], ...]:
    return tuple((f"SG{k}", f"{quantity}.SG{k}", c) for k, c in enumerate((BLUE, SKY, RED, ORANGE), start=1))


_DEGREES = 180.0 / np.pi
_CAR_PANELS = (
    _Panel("Speed", "km/h", (("speed", "speed", BLUE),), 3.6),
    _Panel("Acceleration", "m/s²", (("longitudinal", "chassis.ax", BLUE), ("lateral", "chassis.ay", RED)), 1.0, 0.5),
    _Panel("Vertical acceleration", "m/s²", (("vertical", "chassis.az", GREEN),), 1.0, 0.5),
    _Panel("Wheel loads", "kN", _wheels("Fz"), 1e-3),
    _Panel("Longitudinal forces", "kN", _wheels("Fx"), 1e-3, 0.2),
    _Panel("Lateral forces", "kN", _wheels("Fy"), 1e-3, 0.2),
    _Panel(
        "Inputs",
        "1",
        (("steering", "steering", BLUE), ("throttle", "throttle", GREEN), ("brake", "brake", RED)),
        1.0,
        0.5,
    ),
    _Panel("Wheel travel", "mm", _wheels("travel"), 1e3, 5.0),
    _Panel("Roll and pitch", "deg", (("roll", "chassis.roll", BLUE), ("pitch", "chassis.pitch", RED)), _DEGREES, 1.0),
    _Panel("Yaw rate", "deg/s", (("yaw rate", "chassis.wz", BLUE),), _DEGREES, 2.0),
    _Panel("Sideslip", "deg", (("sideslip", "sideslip", BLUE),), _DEGREES, 1.0),
    _Panel("Bending moments", "N m", _gauges("bending_moment"), 1.0, 1.0),
    _Panel("Gauge stresses", "MPa", _gauges("stress"), 1e-6, 1.0),
)


def car_page(result: Result, rows: Sequence[tuple[str, str]], gates: NDArray[np.float64] | None) -> Figure:
    """Path, summary and panels of a car, on a figure; gates as `hosts.run.result_plots.plot_page` takes them."""
    hidden = () if _has_stresses(result) else ("bending_moment.", "stress.")
    panels = [p for p in _CAR_PANELS if any(n in result and not n.startswith(hidden) for _, n, _ in p.lines)]
    lines = -(-len(panels) // 3)
    height = 4.0 + 2.6 * lines
    layout = ConstrainedLayoutEngine(rect=(0.005, 0.005, 0.99, 1.0 - 0.6 / height), w_pad=0.1, h_pad=0.1)
    figure = plt.figure(figsize=(16, height), layout=layout)
    grid = figure.add_gridspec(lines + 1, 3, height_ratios=(1.2, *[1.0] * lines))
    _draw_path(figure.add_subplot(grid[0, :2]), result, np.zeros((0, 4)) if gates is None else gates)
    draw_table(figure.add_subplot(grid[0, 2]), rows)
    first: Axes | None = None
    for k, panel in enumerate(panels):
        axes = figure.add_subplot(grid[1 + k // 3, k % 3], sharex=first)
        first = first or axes
        _draw_panel(axes, panel, result)
        if k >= len(panels) - 3:
            axes.set_xlabel("time, s")
    return figure


def _draw_panel(axes: Axes, panel: _Panel, result: Result) -> None:
    """Draw the lines of a panel whose variables the result has."""
    series = [(label, panel.factor * _drawn_values(result, n), c) for label, n, c in panel.lines if n in result]
    draw_lines(axes, result.time, series, panel.title, panel.unit, steps=panel.title == "Inputs")
    low, high = axes.get_ylim()
    if high - low < panel.smallest_span:
        middle = 0.5 * (low + high)
        axes.set_ylim(middle - 0.5 * panel.smallest_span, middle + 0.5 * panel.smallest_span)
    if panel.title == "Speed":
        axes.set_ylim(min(0.0, low), 1.05 * high)


def _has_stresses(result: Result) -> bool:
    """Whether moments and stresses were computed; else they are reported as zero."""
    return "stress.computed" in result and bool(result["stress.computed"][0])


def _drawn_values(result: Result, name: str) -> np.ndarray:
    """Values to be drawn: a car that stands has no direction of travel."""
    values = result[name]
    if name != "sideslip" or "chassis.vx" not in result:
        return values
    return np.where(np.abs(result["chassis.vx"]) < _STANDING, np.nan, values)


def _draw_path(axes: Axes, result: Result, gates: NDArray[np.float64]) -> None:
    """Draw the path from above, with gates between cones and a dot at whole seconds."""
    x, y = result["chassis.x"], result["chassis.y"]
    for first, last, right, left in gates:
        axes.add_patch(Rectangle((first, right), last - first, left - right, facecolor="#f6e7c1", edgecolor="none"))
        cones = np.linspace(first, last, 6)
        for edge in (right, left):
            axes.plot(cones, np.full(6, edge), "^", color=ORANGE, markersize=5, zorder=3)
    axes.plot(x, y, color=BLUE, linewidth=2.2, zorder=4)
    interval = max(1.0, np.ceil(result.time[-1] / _MAX_DOTS))
    seconds = np.arange(0.0, result.time[-1] + 1e-9, interval)
    dots = np.clip(np.searchsorted(result.time, seconds), 0, len(x) - 1)
    axes.plot(x[dots], y[dots], "o", color=BLUE, markersize=4, zorder=5)
    axes.annotate("start", (x[0], y[0]), textcoords="offset points", xytext=(0, 8), ha="center", color=BLUE)
    note = _set_scales(axes, x, y, gates)
    interval = interval if len(seconds) > 1 else 1.0
    axes.set_title(f"Path seen from above ({note}; a dot every {interval:g} s)")
    axes.set_xlabel("x, m")
    axes.set_ylabel("y, m")


def _set_scales(axes: Axes, x: np.ndarray, y: np.ndarray, gates: NDArray[np.float64]) -> str:
    """Give both axes the same scale, or stretch y of a long course with small turns; returns a note on it."""
    width, height = max(float(np.ptp(x)), _MIN_WIDTH), float(np.ptp(y))
    reached = np.append(gates[:, 2:], y)
    low, high = float(reached.min()), float(reached.max())
    if height > _MIN_SLENDERNESS * width and high - low < _MAX_SLENDERNESS * width:
        pad = 0.25 * (high - low)
        axes.set_ylim(low - pad, high + pad)
        return "y stretched"
    # a car that stands still or drives straight has no height
    middle, across = 0.5 * float(x.min() + x.max()), 0.5 * float(y.min() + y.max())
    axes.update_datalim([(middle + s * width, across + 0.1 * s * width) for s in (-0.5, 0.5)])
    axes.autoscale_view()
    axes.set_aspect("equal", adjustable="datalim")
    return "same scale on both axes"
