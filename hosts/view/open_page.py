"""The page that was written comes up."""

from __future__ import annotations

from pathlib import Path


def open_page(page: Path) -> None:
    """Open a page in the browser of the user, or say where it is."""
    from viewer.open_browser import open_in_browser

    if not open_in_browser(page):
        print(f"There is no browser to open it here; open {page.absolute()} in one.")
