"""Composes the page of the driving simulator, which connects to the program that serves it."""

from viewer.html_document import html_document

_CONNECT = "'self'"


def simulator_html(title: str) -> str:
    """Text of the page with the script of the viewer.

    It opens a WebSocket to ``/drive`` of its host, with the token of its own address. Raises `ViewerError` if the
    script is missing and cannot be built.
    """
    return html_document(title, {}, "ALi3Viewer.simulate", connect=_CONNECT)
