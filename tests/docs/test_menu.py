"""The menu beside each page of the site."""

import sys
from pathlib import Path
from typing import Any

import pytest

SITE = Path(__file__).parents[2] / "docs" / "_site"
PAGES = {
    "start": "Start\n=====\n\n.. toctree::\n   :hidden:\n\n   guide\n   more\n",
    "guide": "A *guide*\n=========\n\nPart\n----\n\n.. toctree::\n\n   below\n\nOther part\n----------\n",
    "below": "Below\n=====\n\nDeep\n----\n\n.. py:function:: objects()\n",
    "more": "More\n====\n\nEnd\n---\n",
}


def test_the_menu_is_that_of_sphinx_for_whole_contents(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    application = pytest.importorskip("sphinx.application")
    for name, text in PAGES.items():
        (tmp_path / f"{name}.rst").write_text(text, encoding="utf-8")
    monkeypatch.syspath_prepend(str(SITE))
    monkeypatch.delitem(sys.modules, "pages", raising=False)
    settings = {"extensions": ["pages"], "root_doc": "start", "html_theme": "basic"}
    out = tmp_path / "out"
    app = application.Sphinx(tmp_path, None, out, out, "html", settings, status=None, warning=None)
    menus: dict[str, list[str]] = {}

    def look(app: Any, page: str, template: str, context: dict[str, Any], doctree: object) -> None:
        if page in PAGES:
            menu = context["toctree"](collapse=False, titles_only=True, maxdepth=-1, includehidden=True)
            menus.setdefault(page, []).append(menu)

    for priority in (399, 401):  # before and after the project's
        app.connect("html-page-context", look, priority=priority)
    app.build()
    assert set(menus) == set(PAGES)
    for page, (whole, short) in menus.items():
        assert short == whole
        assert all(title in short for title in ("<em>guide</em>", "Below", "More")), page
        assert "Deep" not in short
