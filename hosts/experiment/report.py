"""The page of an experiment: a head, sections with links to them, and plots as SVG with thinned lines."""

from __future__ import annotations

import platform
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ali3.charts import Drawing
from ali3.files import make_folder
from ali3.html_elements import Content, document, element, picture
from hosts.common.program import version_of

if TYPE_CHECKING:
    from lxml.html import HtmlElement

NOTE, FAINT, PROBLEM = "note", "faint", "problem"
"""Kinds of paragraphs."""
MOST_POINTS = 1500
"""Default number of points of a line: about two for each pixel of the width of a plot on a large screen."""


@dataclass(frozen=True)
class Section:
    """A part of the page with a heading."""

    title: str
    parts: Sequence[Content]
    name: str = ""
    """Target of links; by default the number of the section."""


class Plots:
    """Drawings of a page, which are also written as SVG files into a folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def add(self, drawing: Drawing, name: str) -> HtmlElement:
        """Write a drawing. Returns its element in the page. `name`: of the file, without suffix."""
        stem = re.sub(r"[^A-Za-z0-9]+", "_", name).strip("_")[:80]
        drawing.write(make_folder(self.folder) / f"{stem}.svg")
        return picture(drawing)


def page(title: str, facts: Iterable[HtmlElement], sections: Iterable[Section], footer: str = "") -> str:
    """The HTML of the page, which needs no other file. `facts`: elements before the sections."""
    named_sections = [(section.name or f"section-{k}", section) for k, section in enumerate(sections, start=1)]
    links = [element("li", element("a", section.title, href=f"#{name}")) for name, section in named_sections]
    body = [element("h1", title), *facts]
    if len(named_sections) > 1:
        body.append(element("nav", element("ul", *links), aria_label="Sections"))
    for name, section in named_sections:
        heading = element("h2", section.title)
        body.append(element("section", heading, *section.parts, id=name, aria_label=section.title))
    return document(
        title, [*body, element("footer", *([element("p", footer)] if footer else []), paragraph(_provenance()))]
    )


def paragraph(text: str, kind: str = "") -> HtmlElement:
    """A paragraph. `kind`: `NOTE`, `FAINT` or `PROBLEM`."""
    return element("p", text, class_=kind) if kind else element("p", text)


def commands_cell(lines: Sequence[str]) -> HtmlElement:
    """A table cell with commands, a line each."""
    return element("td", *([element("code", line) for line in lines] or ["–"]), class_="commands")


def _provenance() -> str:
    now = datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC")
    return f"{now}, by ALi3 ({version_of('ali3')}) on Python {platform.python_version()}, {platform.platform()}."


def thinned_indices(x: NDArray[np.float64], y: NDArray[np.float64], most_points: int = MOST_POINTS) -> NDArray[np.intp]:
    """Indices of points that are kept: both ends, and the extremes of x and y of each of equal stretches.

    `x`, `y`: shape (n,), NaN in gaps, whose edges are kept; `most_points`: approximate number of points.
    """
    n = len(x)
    stretches = max(1, most_points // 4)
    if n <= most_points:
        return np.arange(n)
    length = -(-n // stretches)
    starts = np.arange(0, n, length)
    indices = [np.array([0, n - 1])]
    for values in (x, y):
        for fill, extreme in ((np.inf, np.argmin), (-np.inf, np.argmax)):
            padded = np.full(len(starts) * length, fill)
            padded[:n] = np.where(np.isnan(values), fill, values)
            indices.append(starts + extreme(padded.reshape(len(starts), length), axis=1))
    is_gap = np.isnan(x) | np.isnan(y)
    edges = np.flatnonzero(is_gap[1:] != is_gap[:-1])
    if len(edges) <= most_points:
        indices += [edges, edges + 1]
    return np.asarray(np.unique(np.minimum(np.concatenate(indices), n - 1)), np.intp)
