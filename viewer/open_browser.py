"""Opens a page in the browser of the user."""

import os
import sys
import webbrowser
from html import escape
from pathlib import Path

from ali3 import html


def open_in_browser(path: str | os.PathLike[str]) -> bool:
    """Show a page in the browser of the user. Returns whether there is one; a machine without a screen has none."""
    return open_address(Path(path).resolve().as_uri())


def open_address(address: str) -> bool:
    """Show an address in the browser of the user. Returns whether there is one, see `open_in_browser`."""
    if sys.platform.startswith("linux") and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        return False  # a browser in the terminal would draw nothing
    try:
        return webbrowser.open(address)
    except webbrowser.Error:
        return False


def open_secretly(address: str, folder: str | os.PathLike[str]) -> bool:
    """Show an address that must remain secret; see `open_address`.

    All users of a machine can see the command line of a browser; it names a page that redirects to the address.

    `folder`: readable only for this user; it must exist until the browser has read the page.
    """
    target = escape(address, quote=True)
    page = html.page(
        "ALi3", f'<a href="{target}">Go on</a>', head=f'<meta http-equiv="refresh" content="0;url={target}">'
    )
    file = Path(folder, "open.html")
    file.write_text(page, encoding="utf-8")
    return open_in_browser(file)
