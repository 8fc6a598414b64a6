"""Pages of the site that are files elsewhere in the repository, such as the README."""

from __future__ import annotations

import re
from pathlib import Path

from sphinx.application import Sphinx

ROOT = Path(__file__).parents[2]
BESIDE = "---\norphan: true\n---\n"
PAGES = {
    "index": "README.md",
    "changelog": "CHANGELOG.md",
    "contributing": "CONTRIBUTING.md",
    "method_contract": "mbs/kernel/src/methods/README.md",
}
LINK = re.compile(r"(\]\()(?!https?:|#|mailto:)([^)\s]+)\)")


def with_file(app: Sphinx, page: str, source: list[str]) -> None:
    """Put the repository's file before what the page has itself, its links as seen from `docs/`."""
    if page.startswith("decisions/0"):  # their list is a page; in the menu they would stand beside every page
        source[0] = BESIDE + source[0]
    if page not in PAGES:
        return
    file = ROOT / PAGES[page]
    app.env.note_dependency(str(file))
    text = LINK.sub(lambda m: f"{m[1]}{_target(file, m[2])})", file.read_text(encoding="utf-8"))
    source[0] = text + "\n" + source[0]


def _target(file: Path, link: str) -> str:
    """What a link of the file leads to, as seen from `docs/`."""
    path, mark, anchor = link.partition("#")
    place = (file.parent / path).resolve().relative_to(ROOT).as_posix()
    page = next((page for page, source in PAGES.items() if source == place), None)
    seen = f"{page}.md" if page else place.removeprefix("docs/") if place.startswith("docs/") else f"../{place}"
    return seen + mark + anchor


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the hook."""
    app.connect("source-read", with_file)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
