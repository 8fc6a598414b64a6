"""Elements of HTML; text in them is escaped because it is text."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, TypeAlias

from lxml.html import builder

if TYPE_CHECKING:
    from lxml.html import HtmlElement

Content: TypeAlias = "HtmlElement | str"
_FORBIDDEN = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ufffe\uffff\ud800-\udfff]")
"""What no text of a document can have."""


def element(tag: str, /, *content: Content, **attributes: Any) -> HtmlElement:
    """One element.

    Parameters
    ----------
    **attributes : object
        A trailing underscore is left out, others become hyphens.
    """
    made = getattr(builder, tag.upper(), None)
    node = made() if made is not None else builder.E(tag)
    for key, value in attributes.items():
        node.set(key.rstrip("_").replace("_", "-"), clean(str(value)))
    for part in content:
        if not isinstance(part, str):
            node.append(part)
        elif len(node):
            node[-1].tail = (node[-1].tail or "") + clean(part)
        else:
            node.text = (node.text or "") + clean(part)
    return node


def clean(text: str) -> str:
    """Text without characters that a document cannot have."""
    return _FORBIDDEN.sub("\ufffd", text)


def table(
    caption: str, head: list[Content], rows: list[list[Content]], groups: dict[int, str] | None = None
) -> HtmlElement:
    """A table that can be scrolled sideways; the first cell of a row is its header.

    Parameters
    ----------
    rows : list of list of HtmlElement or str
        A cell that is itself a ``td`` is taken as it is.
    groups : dict of int to str, optional
        Headings over rows, by the row's number.
    """
    body = []
    for k, row in enumerate(rows):
        if groups and k in groups:
            body.append(element("tr", element("th", groups[k], colspan=len(head), scope="colgroup", class_="group")))
        cells = [c if not isinstance(c, str) and c.tag == "td" else element("td", c) for c in row[1:]]
        body.append(element("tr", element("th", row[0], scope="row"), *cells))
    heads = [element("th", cell, scope="col") if cell else element("td") for cell in head]
    made = element(
        "table", element("caption", caption), element("thead", element("tr", *heads)), element("tbody", *body)
    )
    return element("div", made, class_="wide", tabindex=0, role="region", aria_label=caption)
