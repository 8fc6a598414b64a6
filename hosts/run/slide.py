"""A summary that fits a slide: the main numbers at the left, up to three plots at the right, 16 to 9."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Sequence
from itertools import accumulate
from pathlib import Path
from typing import Any, TypeAlias

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot as plt
from matplotlib.axes import Axes

from ali3.chart_style import BLACK, STYLE
from ali3.charts import save_pictures

Draw: TypeAlias = Callable[[Axes], object]
"""Draws into axes."""

MOST_ROWS, MOST_PLOTS = 14, 3
_SIZE = (13.333, 7.5)
_STYLE: dict[Any, Any] = {**STYLE, "font.size": 9.5, "axes.titlesize": 10.5, "legend.fontsize": 8}
_SUBTITLE = 165  # characters that fit
_CHARACTERS, _BETWEEN, _FITTING = 44, 3, 84  # of the first column at most, between columns, of a whole row


def write_slide(
    stem: Path, title: str, subtitle: str, head: Sequence[str], rows: Sequence[Sequence[str]], plots: Sequence[Draw]
) -> list[Path]:
    """Write a page as SVG and PNG.

    `rows`: at most `MOST_ROWS` are shown; a sentence below tells of the others; `plots`: at most `MOST_PLOTS`.
    """
    plots, subtitle = plots[:MOST_PLOTS], textwrap.shorten(subtitle, _SUBTITLE, placeholder=" ...")
    with plt.rc_context(_STYLE):
        figure = plt.figure(figsize=_SIZE, layout="constrained")
        engine: Any = figure.get_layout_engine()
        engine.set(rect=(0.015, 0.01, 0.97, 0.865), h_pad=0.12, w_pad=0.15)
        grid = figure.add_gridspec(max(len(plots), 1), 2, width_ratios=(1.25, 1.0))
        texts = [
            figure.text(0.02, 0.965, title, fontsize=20, fontweight="bold", va="top"),
            figure.text(0.02, 0.905, subtitle, fontsize=10.5, color="#555555", va="top"),
        ]
        texts += _table(figure.add_subplot(grid[:, 0]), head, rows)
        for k, draw in enumerate(plots):
            draw(figure.add_subplot(grid[k, 1]))
        for text in texts:
            text.set_parse_math(False)
        return save_pictures(figure, stem)


def _table(axes: Axes, head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[Any]:
    axes.axis("off")
    axes.set(xlim=(0.0, 1.0), ylim=(MOST_ROWS + 1.5, -0.6))
    lengths = [max(map(len, column)) for column in zip(head, *rows[:MOST_ROWS], strict=True)]
    lengths[0] = min(lengths[0], _CHARACTERS)
    whole = sum(lengths) + _BETWEEN * (len(head) - 1)
    size = _STYLE["font.size"] * min(1.0, _FITTING / whole)
    ends = list(accumulate(lengths, lambda end, length: end + _BETWEEN + length))
    places = [0.0, *(end / ends[-1] for end in ends[1:])]  # the left of the first column, the right of the others
    texts = []
    for line, row in enumerate([head, *rows[:MOST_ROWS]]):
        for k, (place, cell) in enumerate(zip(places, row, strict=True)):
            words = textwrap.fill(cell, _CHARACTERS) if k == 0 else cell
            weight = "bold" if line == 0 else "normal"
            aligned = "right" if k else "left"
            style = {"color": BLACK, "fontweight": weight, "fontsize": size}
            texts.append(axes.text(place, line, words, ha=aligned, va="center", **style))
        axes.axhline(line + 0.5, color="#bbbbbb" if line == 0 else "#e8e8e8", linewidth=0.8)
    if len(rows) > MOST_ROWS:
        words = f"and {len(rows) - MOST_ROWS} more in the report"
        texts.append(axes.text(0.0, MOST_ROWS + 1.0, words, va="center", color="#555555"))
    return texts
