"""HTML elements for reports; their text is always escaped."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import lxml.html
from lxml.html import builder

from ali3 import html
from ali3.message_text import clean

if TYPE_CHECKING:
    from lxml.html import HtmlElement

    from ali3.charts import Drawing

Content: TypeAlias = "HtmlElement | str"


def element(tag: str, /, *content: Content, **attributes: Any) -> HtmlElement:
    """An element. `attributes`: a trailing underscore is removed, others become hyphens."""
    make = getattr(builder, tag.upper(), None)
    node = make() if make is not None else builder.E(tag)
    for key, value in attributes.items():
        node.set(key.rstrip("_").replace("_", "-"), clean(str(value)))
    for item in content:
        if not isinstance(item, str):
            node.append(item)
        elif len(node):
            node[-1].tail = (node[-1].tail or "") + clean(item)
        else:
            node.text = (node.text or "") + clean(item)
    return node


def table(
    caption: str, head: Sequence[Content], rows: Iterable[Sequence[Content]], kind: str | None = None
) -> HtmlElement:
    """A table that can be scrolled sideways; the first cell of a row is its header.

    `caption`: above the table; empty: none; `rows`: a row of one cell is the heading of the following rows; a cell may
    be a ``td`` itself; `kind`: class of the table.
    """
    body = []
    for header, *contents in rows:
        if contents:
            cells = [c if not isinstance(c, str) and c.tag == "td" else element("td", c) for c in contents]
            body.append(element("tr", element("th", header, scope="row"), *cells))
        else:
            body.append(element("tr", element("th", header, colspan=len(head), scope="colgroup", class_="group")))
    header_cells = [element("th", cell, scope="col") if cell else element("td") for cell in head]
    caption_elements, region_attributes = (
        ([element("caption", caption)], {"role": "region", "aria_label": caption}) if caption else ([], {})
    )
    children = [*caption_elements, element("thead", element("tr", *header_cells)), element("tbody", *body)]
    content = element("table", *children) if kind is None else element("table", *children, class_=kind)
    return element("div", content, class_="wide", tabindex=0, **region_attributes)


def picture(drawing: Drawing) -> HtmlElement:
    """A drawing embedded in the page, with its alternative text."""
    source = f"data:image/svg+xml;base64,{base64.b64encode(drawing.svg).decode('ascii')}"
    width, height = map(str, drawing.size)
    # The size reserves the space of a picture not drawn yet, so that links to later sections end at the right place.
    image = element("img", alt=drawing.words, src=source, width=width, height=height, loading="lazy")
    return element("figure", image, class_="plot")


def document(title: str, body: Iterable[HtmlElement]) -> str:
    """A self-contained HTML file in the style of all reports."""
    return html.report(clean(title), markup(body))


def markup(elements: Iterable[HtmlElement]) -> str:
    """HTML text of elements."""
    return "\n".join(str(lxml.html.tostring(item, encoding="unicode", method="html")) for item in elements)
