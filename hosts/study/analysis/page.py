"""Pieces of one HTML file that needs nothing else, in the style of the catalogue's report."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from hosts.catalogue.report import document as shell
from hosts.catalogue.report import elements
from hosts.catalogue.report.elements import Content, element

if TYPE_CHECKING:
    from lxml.html import HtmlElement

_STYLE = """
td code { display: block; margin-bottom: 0.2rem; user-select: all; font-size: 0.78rem; min-width: 24rem; }
table.small, .wide table { font-size: 0.85rem; } td { min-width: 0; }
"""


def document(title: str, body: Iterable[HtmlElement]) -> str:
    """The whole file."""
    return shell.document(title, element("main", *body), _STYLE)


def paragraph(text: str, kind: str = "") -> HtmlElement:
    """A paragraph; kind ``faint`` or ``note``."""
    return element("p", text, class_=kind) if kind else element("p", text)


def table(caption: str, head: Sequence[str], rows: Iterable[Sequence[Content]]) -> HtmlElement:
    """A table that can be scrolled sideways."""
    return elements.table(caption, list(head), [list(row) for row in rows])


def commands_cell(lines: Iterable[str]) -> HtmlElement:
    """A cell with commands to be copied."""
    return element("td", *([element("code", line) for line in lines] or ["–"]))


def picture(png: bytes, what: str) -> HtmlElement:
    """An image within the file."""
    source = f"data:image/png;base64,{base64.b64encode(png).decode()}"
    return element("figure", element("img", alt=what, src=source), class_="plot")
