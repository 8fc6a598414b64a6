"""Pieces of one HTML file that needs nothing else, in the style of the catalogue's report."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from ali3 import html_elements
from ali3.html_elements import element

if TYPE_CHECKING:
    from lxml.html import HtmlElement

_STYLE = """
td code { display: block; margin-bottom: 0.2rem; user-select: all; font-size: 0.78rem; min-width: 24rem; }
table.small, .wide table { font-size: 0.85rem; } td { min-width: 0; }
"""


def document(title: str, body: Iterable[HtmlElement]) -> str:
    """The whole file."""
    return html_elements.document(title, body, _STYLE)


def paragraph(text: str, kind: str = "") -> HtmlElement:
    """A paragraph; kind ``faint`` or ``note``."""
    return element("p", text, class_=kind) if kind else element("p", text)


def commands_cell(lines: Iterable[str]) -> HtmlElement:
    """A cell with commands to be copied."""
    return element("td", *([element("code", line) for line in lines] or ["–"]))
