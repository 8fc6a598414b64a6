"""One HTML file that needs nothing else."""

from __future__ import annotations

from importlib.resources import files
from typing import TYPE_CHECKING

from lxml import html

from hosts.catalogue.report.elements import element

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
    page = element(
        "html",
        element(
            "head",
            element("meta", charset="utf-8"),
            element("title", title),
            element("meta", name="viewport", content="width=device-width, initial-scale=1"),
            element("style", files(__package__).joinpath("page.css").read_text("utf-8") + style),
        ),
        element("body", main),
        lang="en",
    )
    return str(html.tostring(page, encoding="unicode", doctype="<!DOCTYPE html>", method="html")) + "\n"
