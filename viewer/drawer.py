"""The drawer of recordings, which the engine finds by the entry point ``page`` of ``ali3.drawers``."""

import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ali3.scene.recording import Recording
from viewer.browser import BrowserError
from viewer.gltf import write_gltf
from viewer.notebook import html_of
from viewer.open_browser import open_in_browser
from viewer.page_file import write_page
from viewer.player_options import check_options
from viewer.video import write_mp4

__all__ = ["check_options", "html_of", "show", "write_gltf", "write_mp4", "write_page"]


def show(recordings: Sequence[Recording], options: Mapping[str, Any]) -> Path:
    """Write a page to a temporary folder and open it in the browser of the user.

    Raises `BrowserError` if there is no browser or screen; `ViewerError` if the script of the page is missing.
    """
    page = Path(tempfile.mkdtemp(prefix="ali3-animation-"), "animation.html")
    path = write_page(page, recordings, options=options).path
    if not open_in_browser(path):
        raise BrowserError(
            f"No browser can be opened here; the page is {path}, and save(path) writes it elsewhere: open it "
            "in a browser on any machine."
        )
    return path
