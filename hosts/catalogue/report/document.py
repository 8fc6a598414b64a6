"""One HTML file that needs nothing else."""

from __future__ import annotations

from typing import TYPE_CHECKING

import lxml.html

from ali3 import html
from hosts.catalogue.report.elements import clean

if TYPE_CHECKING:
    from lxml.html import HtmlElement


def document(title: str, main: HtmlElement, style: str = "") -> str:
    """The text of the file.

    Parameters
    ----------
    main : HtmlElement
        All that is shown.
    style : str
        CSS besides that of all reports.
    """
    body = "".join(str(lxml.html.tostring(part, encoding="unicode", method="html")) for part in main)
    return html.report(clean(title), body, style)
