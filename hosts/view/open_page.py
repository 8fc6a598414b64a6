"""Opens a written page in the browser of the user."""

from pathlib import Path

from viewer.open_browser import open_in_browser


def open_page(page: Path) -> None:
    """Open a page in the browser of the user, or say where it is."""
    if not open_in_browser(page):
        print(f"There is no browser to open it here; open {page.absolute()} in one.")
