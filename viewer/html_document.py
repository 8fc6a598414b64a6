"""Composes HTML pages of the script of the viewer and data."""

import json
from html import escape

from ali3 import html
from ali3.scene.errors import ViewerError
from viewer.bundle import bundle

# FMUs are WebAssembly and run in a worker made of the script of the page.
_SOURCES = {"script-src": "'wasm-unsafe-eval'", "worker-src": "blob:"}

_STYLE = "html,body{margin:0;height:100%;overflow:hidden;font:14px/1.4 system-ui,sans-serif}#view{height:100%}"
_HEADING = "h1{position:absolute;width:1px;height:1px;margin:-1px;overflow:hidden;clip-path:inset(50%)}"
"""Style that shows the heading only to screen readers."""


def html_document(title: str, data: object, page_class: str, connect: str = "") -> str:
    """An HTML page with the script of the viewer, which makes an object of a class from data.

    Parameters
    ----------
    title : str
        Title of the page; any text.
    data : object
        Content for `json.dumps`, with any texts.
    page_class : str
        Class in the script, made from the element to fill and the data; the object becomes ``window.player``.
    connect : str
        Addresses of the content security policy to which the page may connect; by default none.

    Raises
    ------
    ViewerError
        The script is missing and cannot be built.
    """
    # The page shows the error if it cannot run.
    start = (
        "(function(){var view=document.getElementById('view'),data=document.getElementById('data').textContent;"
        "try{window.player=new ALi3Viewer." + page_class + "(view,JSON.parse(data));}"
        "catch(error){view.textContent='This page cannot be shown: '+(error&&error.message||error);}})();"
    )
    body = (
        f'<header><h1>{escape(title)}</h1></header>\n<main id="view"></main>\n'
        "<noscript>This page draws with JavaScript, which is switched off in this browser.</noscript>\n"
        f'<script type="application/json" id="data">{json_in_html(data)}</script>'
    )
    sources = _SOURCES | ({"connect-src": connect} if connect else {})
    return html.page(title, body, _STYLE + _HEADING, scripts=(script(), start), sources=sources)


def script() -> str:
    """The script of the viewer, which defines ``window.ALi3Viewer``.

    Raises `ViewerError` if it is missing and cannot be built.
    """
    try:
        return bundle().read_text(encoding="utf-8")
    except RuntimeError as error:
        raise ViewerError(str(error)) from None


def json_in_html(data: object) -> str:
    """JSON for a script element: no text in it can end the element or begin a comment.

    `data`: argument of `json.dumps`; numbers must be finite.
    """
    text = json.dumps(data, ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")
