"""One HTML file that needs nothing else."""

from __future__ import annotations

from importlib.resources import files
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
    title : str
    main : HtmlElement
        All that is shown.
    style : str
        CSS besides that of all reports.
    """
    body = str(lxml.html.tostring(main, encoding="unicode", method="html"))
    return html.page(clean(title), body, files(__package__).joinpath("page.css").read_text("utf-8") + style)
