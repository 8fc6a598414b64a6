"""Writes charts as files, which also store their texts, so that two versions of a picture can be compared."""

from __future__ import annotations

from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

from ali3.message_text import clean

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_KEY = "Description"
"""One of the keywords that PNG defines for texts."""
_PICTURE_DOTS_PER_INCH = 110


def save_figure(figure: Figure, file: Path) -> None:
    """Write a figure as the kind of file that its suffix names, without one as a PNG, which has its description."""
    make_plain(figure)
    kind = file.suffix[1:].lower() or "png"
    # without `Software` all versions of Matplotlib write the same bytes
    metadata = {"Software": None, _KEY: describe(figure)} if kind == "png" else None
    figure.savefig(file, format=kind, dpi=_PICTURE_DOTS_PER_INCH, metadata=metadata)


def make_plain(figure: Figure) -> None:
    """Show texts of a figure as they are: names of files and columns may look like formulas or not be characters."""
    from matplotlib.text import Text

    for text in figure.findobj(Text):
        if content := text.get_text():  # before a figure is drawn, ticks, whose labels are formulas, have none
            text.set_text(clean(content))
            text.set_parse_math(False)


def describe(figure: Figure) -> str:
    """Describe a figure: a line for its title, one for axes and curves of each panel, one for each text.

    Texts at the same height, such as a row of a table, are one line.
    """
    lines = [figure.get_suptitle()]
    for axes in figure.axes:
        lines += _panel_lines(axes)
    lines += [f"legend: {text.get_text()}" for legend in figure.legends for text in legend.get_texts()]
    return "\n".join(" ".join(line.split()) for line in lines if line)


def read_description(file: Path) -> str:
    """Read the description in a PNG or SVG file; empty if there is none."""
    if file.suffix == ".svg":
        from lxml import etree

        return str(etree.parse(file).findtext("{*}desc", ""))
    from PIL import Image

    with Image.open(file) as picture:
        return str(picture.info.get(_KEY, ""))


def _panel_lines(axes: Axes) -> list[str]:
    """Describe a panel, then the texts in it."""
    title = " ".join(filter(None, map(axes.get_title, ("left", "center", "right"))))  # type: ignore[arg-type]
    curves = axes.get_legend_handles_labels()[1]
    parts = {"panel": title, "x": axes.get_xlabel(), "y": axes.get_ylabel(), "curves": ", ".join(curves)}
    # Texts of a row follow each other in `axes.texts`.
    rows = groupby(axes.texts, lambda text: text.get_position()[1])
    row_texts = [": ".join(filter(None, (text.get_text() for text in row))) for _, row in rows]
    return ["; ".join(f"{name} {text}" for name, text in parts.items() if text), *filter(None, row_texts)]
