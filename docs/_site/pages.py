"""Pages of the site that are files elsewhere in the repository, such as the README."""

import re
from functools import cache
from pathlib import Path
from typing import Any
from unittest.mock import patch

from docutils import nodes
from sphinx import addnodes
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
    location = (file.parent / path).resolve().relative_to(ROOT).as_posix()
    page = next((page for page, source in PAGES.items() if source == location), None)
    target = (
        f"{page}.md" if page else location.removeprefix("docs/") if location.startswith("docs/") else f"../{location}"
    )
    return target + mark + anchor


def with_short_menu(app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: object) -> None:
    """Make the menu from titles: Sphinx copies all headings and objects of each page for each page, and drops them."""
    full_menu = context["toctree"]

    def menu(**options: Any) -> str:
        if not options.get("titles_only"):
            return full_menu(**options)
        with patch.object(app.env, "tocs", _titles(app)):
            return full_menu(**options)

    context["toctree"] = menu


@cache
def _titles(app: Sphinx) -> dict[str, nodes.bullet_list]:
    return {page: _title(toc) for page, toc in app.env.tocs.items()}


def _title(toc: nodes.bullet_list) -> nodes.bullet_list:
    """What a menu of titles keeps of a page's contents."""
    titles = toc.copy()
    for entry in toc.children:
        titles += nodes.list_item("", *(child.deepcopy() for child in entry[:1]))
        subtrees = [tree.deepcopy() for tree in entry.findall(addnodes.toctree)]
        if subtrees:
            titles[-1] += nodes.bullet_list("", *subtrees)
    return titles


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the hooks."""
    app.connect("source-read", with_file)
    app.connect("html-page-context", with_short_menu, priority=400)  # before the theme asks for the menu
    return {"parallel_read_safe": True, "parallel_write_safe": True}
