"""Pages of the site that are files of the repository: README, CHANGELOG, CONTRIBUTING, examples."""

from __future__ import annotations

import re
from pathlib import Path

from sphinx.application import Sphinx

ROOT = Path(__file__).parents[2]
DECISIONS = "\n```{toctree}\n:hidden:\n:glob:\n\n0*\n```\n"
PAGES = {"index": "README.md", "changelog": "CHANGELOG.md", "contributing": "CONTRIBUTING.md"}


def with_file(app: Sphinx, page: str, source: list[str]) -> None:
    """Put the repository's file before what the page has itself, its links as seen from `docs/`."""
    if page == "decisions/README":
        source[0] += DECISIONS
    if page not in PAGES:
        return
    text = (ROOT / PAGES[page]).read_text(encoding="utf-8")
    text = re.sub(r"(\]\()(?!https?:|#|mailto:)([^)\s]+)\)", _link, text)
    source[0] = text + "\n" + source[0]


def _link(match: re.Match[str]) -> str:
    target = match[2]
    for page, file in PAGES.items():
        if target.partition("#")[0] == file:
            return match[1] + target.replace(file, f"{page}.md") + ")"
    return match[1] + (target.removeprefix("docs/") if target.startswith("docs/") else f"../{target}") + ")"


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the hook."""
    app.connect("source-read", with_file)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
