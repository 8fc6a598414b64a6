"""Panels of which pages of plots are composed."""

from collections.abc import Sequence
from textwrap import wrap

import numpy as np
from matplotlib.axes import Axes

from ali3.chart_style import BLACK
from ali3.units import typeset

_CHARACTERS = 44


def draw_table(axes: Axes, rows: Sequence[tuple[str, str]]) -> None:
    """The summary, in axes of its own."""
    axes.axis("off")
    axes.set_title("Summary")
    lines = [
        (label if k == 0 else "", part) for label, value in rows for k, part in enumerate(wrap(value, _CHARACTERS))
    ]
    n = max(len(lines), 10)
    for k, line in enumerate(lines):
        for x, message, colour in zip((0.0, 0.42), line, ("#555555", BLACK), strict=True):
            text = axes.text(x, 1.0 - (k + 0.5) / n, message, transform=axes.transAxes, va="center", fontsize=8)
            text.set(color=colour, in_layout=False)  # or the layout leaves its width free beside all panels


def draw_lines(
    axes: Axes, t: np.ndarray, series: Sequence[tuple[str, np.ndarray, str]], title: str, unit: str, steps: bool = False
) -> None:
    """Curves of one unit over time t, s, each by label, values and colour; `steps` where each value ends a step."""
    for label, values, colour in series:
        # The right wheels are dashed, so that the left ones show through where they do the same.
        style = (0, (4, 3)) if label in ("FR", "RR") else "-"
        axes.plot(t, values, color=colour, label=label, linestyle=style, drawstyle="steps-pre" if steps else "default")
    axes.set_title(title, loc="left")
    axes.set_ylabel(typeset(unit))
    axes.margins(x=0)
    if len(series) > 1:
        axes.legend(
            ncols=len(series),
            loc="lower right",
            bbox_to_anchor=(1.01, 0.985),
            borderaxespad=0.1,
            handlelength=1.1,
            columnspacing=0.7,
            handletextpad=0.4,
        )
