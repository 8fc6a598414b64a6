"""Plots of curves: a figure of wheel travel for each axle, and one of steering."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ali3.chart_style import BLUE, GREEN, RED, STYLE
from mbs.vehicle.kinematics.car_kinematics import Kinematics
from mbs.vehicle.kinematics.curves import WORDS, Curve
from mbs.vehicle.kinematics.quantities import BY_NAME

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = {"parallel": BLUE, "opposite": RED, "single": GREEN, "left": BLUE, "right": RED}
_STYLE: dict[Any, Any] = {**STYLE, "font.size": 9, "axes.titlesize": 10, "legend.fontsize": 8}
TRAVEL_PANELS = (
    ("toe_angle", ("parallel", "opposite", "single")),
    ("camber_angle", ("parallel", "opposite", "single")),
    ("track_change", ("parallel", "opposite")),
    ("wheelbase_change", ("parallel",)),
    ("caster_angle", ("parallel",)),
    ("kingpin_inclination_angle", ("parallel",)),
    ("caster_trail", ("parallel",)),
    ("kingpin_offset_at_ground", ("parallel",)),
    ("roll_centre_height", ("parallel", "opposite")),
    ("anti_dive", ("parallel",)),
    ("anti_lift", ("parallel",)),
    ("anti_squat", ("parallel",)),
    ("anti_lift_in_drive", ("parallel",)),
    ("spring_ratio", ("parallel", "opposite")),
    ("damper_ratio", ("parallel", "opposite")),
    ("anti_roll_bar_ratio", ("opposite",)),
    ("spring_load", ("parallel", "opposite")),
    ("wheel_rate", ("parallel", "opposite")),
    ("ride_rate", ("parallel", "opposite")),
)
"""Quantities against wheel travel, and the motions in each panel."""
STEER_PANELS = (
    "steer_angle",
    "steering_ratio",
    "ackermann",
    "ackermann_error",
    "turning_circle",
    "camber_angle",
    "caster_angle",
    "kingpin_inclination_angle",
    "caster_trail",
    "kingpin_offset_at_ground",
    "track_change",
)
"""Quantities against the angle of the steering wheel."""
COLUMNS = 4
DASHES = {"opposite": (0, (5, 2)), "single": (0, (1, 1.5))}
"""Line styles of motions whose curves may coincide with the curves of parallel travel."""
MAX_CIRCLE = 60.0  # m, end of the axis of turning circles


def travel_figure(kinematics: Kinematics, axle: str) -> Figure:
    """Panels of the left wheel of an axle against wheel travel."""
    curves = {motion: c for (of, motion), c in kinematics.curves.items() if of == axle and motion != "steer"}
    panels = [(name, motions) for name, motions in TRAVEL_PANELS if _column(curves["parallel"], name)]

    def draw(ax: Axes, k: int) -> None:
        name, motions = panels[k]
        for motion in motions:
            _plot(ax, curves[motion], name, "left", COLOURS[motion], WORDS[motion], DASHES.get(motion, "-"))
        _set_labels(ax, name)
        ax.set_xlabel("wheel travel, mm (bump positive)")

    return _figure(f"{kinematics.car}: {axle} axle over wheel travel", len(panels), draw)


def steer_figure(kinematics: Kinematics) -> Figure:
    """Panels of the front axle against the angle of the steering wheel."""
    curve = kinematics.curves["front", "steer"]

    def draw(ax: Axes, k: int) -> None:
        name = STEER_PANELS[k]
        sides = ("left", "right") if f"{name}_left" in curve.columns else ("",)
        for side in sides:
            _plot(ax, curve, name, side, COLOURS.get(side, COLOURS["left"]), f"{side} wheel" if side else "")
        _set_labels(ax, name)
        if name == "turning_circle":
            ax.set_ylim(0.0, MAX_CIRCLE)
        ax.set_xlabel("steering-wheel angle, deg (left positive)")

    return _figure(f"{kinematics.car}: front axle over steering", len(STEER_PANELS), draw)


def _figure(title: str, panels: int, draw: Any) -> Figure:
    """Figure of panels. `draw`: draws a panel by axes and number."""
    import matplotlib as mpl
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    rows = -(-panels // COLUMNS)
    with mpl.rc_context(_STYLE):
        figure = Figure(figsize=(3.4 * COLUMNS, 2.5 * rows + 0.5), layout="constrained")
        FigureCanvasAgg(figure)
        grid: Sequence[Axes] = list(figure.subplots(rows, COLUMNS, squeeze=False).flat)
        for k, ax in enumerate(grid):
            if k < panels:
                draw(ax, k)
            else:
                ax.set_axis_off()
        figure.suptitle(title, x=0.01, ha="left", fontsize=14, fontweight="bold")
    return figure


def _column(curve: Curve, name: str, side: str = "left") -> str:
    """Name of the column of a quantity; empty if there is none."""
    return next((column for column in (f"{name}_{side}", name) if column in curve.columns), "")


def _plot(ax: Axes, curve: Curve, name: str, side: str, colour: str, label: str, dashes: Any = "-") -> None:
    """Plot a quantity of a curve against the variable of its motion."""
    over = BY_NAME[curve.over.removesuffix("_left")]
    column = _column(curve, name, side)
    ax.plot(
        curve[curve.over] * over.factor,
        curve[column] * BY_NAME[name].factor,
        color=colour,
        label=label,
        linestyle=dashes,
    )


def _set_labels(ax: Axes, name: str) -> None:
    """Set title, label and legend of a panel, and a range of the y axis that exceeds round-off."""
    quantity = BY_NAME[name]
    ax.set_title(quantity.title)
    ax.set_ylabel(quantity.shown)
    low, high = ax.get_ylim()
    least = 1e-3 * max(1.0, abs(low))
    if high - low < least:
        middle = 0.5 * (low + high)
        ax.set_ylim(middle - least, middle + least)
    if len(ax.lines) > 1:
        ax.legend()
