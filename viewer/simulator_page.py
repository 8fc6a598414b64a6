"""The page of the driving simulator: one HTML file that connects to the program that serves it."""

from viewer.html_document import html_document

_CONNECT = "'self'"


def simulator_html(title: str) -> str:
    """The text of the page, with the script of the viewer in it.

    It opens a WebSocket to the address ``/drive`` of the host that it comes from, with the token of its own address.

    `title`: of the page; any text. Raises `ViewerError`: the script is not there and cannot be built.
    """
    return html_document(title, {}, "ALi3Viewer.simulate", connect=_CONNECT)
