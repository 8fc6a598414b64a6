"""Reports in a browser: axe-core finds nothing in light and dark with all that can be opened open, and links end where
they lead to.
"""

from pathlib import Path
from typing import Any

import pytest

from ali3.html_elements import document, element, table
from hosts.catalogue.report import write_report
from hosts.study.analysis.report import report_of
from tests.hosts.catalogue.synthetic_records import synthetic
from tests.hosts.study.frames import frame_of
from tests.in_browser import axe_findings, headless_chromium, with_axe

OPEN = "() => document.querySelectorAll('details').forEach((part) => { part.open = true; })"


def written(folder: Path) -> list[Path]:
    """A report of the catalogue, one of a study with two measures, and one of the tables of the others."""
    catalogue, tables = folder / "catalogue.html", folder / "tables.html"
    write_report(catalogue, *synthetic(folder / "none.fmu", tests=2, points=100))
    x = {"mass": [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]}
    frame = frame_of(
        x, {"peak": [1.0, 4.0, 2.0, 5.0, 3.0, 6.0], "rest": [3.0, 1.0, 2.0, 6.0, 5.0, 4.0]}, {"mass": "kg"}
    )
    study, *_ = report_of(frame, folder, lambda index: [f"ali3 run {index}"])
    body = [element("h1", "Axles"), table("", ["", "front", "rear"], [["Axles"], ["toe", "1", "2"]])]
    tables.write_text(document("Axles", body), encoding="utf-8")
    return [catalogue, study, tables]


@with_axe
@pytest.mark.slow
def test_axe_finds_nothing_in_reports(tmp_path: Path) -> None:
    files = written(tmp_path)
    results: dict[str, Any] = {}
    with headless_chromium() as chromium:
        for colours in ("light", "dark"):
            page = chromium.new_page(viewport={"width": 900, "height": 700}, color_scheme=colours)
            for file in files:
                page.goto(file.as_uri())
                page.evaluate(OPEN)
                results[f"{file.name} {colours}"] = axe_findings(page)
            page.close()
    assert {key: message for key, message in results.items() if message} == {}
    assert len(results) == 6


@pytest.mark.slow
@pytest.mark.drawn
def test_links_of_the_catalogue_end_at_their_heading(tmp_path: Path) -> None:
    """In a window that is opened anew for each, since pictures above the heading are drawn late."""
    file = tmp_path / "report.html"
    write_report(file, *synthetic(tmp_path / "none.fmu", tests=12, points=100))
    follow = """async (name) => {
      const ended = new Promise((done) => addEventListener('scrollend', done, { once: true }));
      document.querySelector(`nav a[href='#${name}']`).click();
      await ended;
      await new Promise((done) => setTimeout(done, 200)); // pictures that are drawn now would move the heading
      const { scrollHeight } = document.documentElement;
      return [document.getElementById(name).getBoundingClientRect().top, scrollY + innerHeight >= scrollHeight - 1];
    }"""
    late = "() => [...document.images].filter((image) => !image.complete).length"
    with headless_chromium() as chromium:
        for width in (900, 390):
            for k in (5, 11):
                page = chromium.new_page(viewport={"width": width, "height": 700})
                page.goto(file.as_uri())
                waiting = page.evaluate(late)
                top, is_end = page.evaluate(follow, f"test_{k}")
                page.close()
                assert waiting > 3 * k  # those above it
                assert is_end or abs(top) < 3.0, (width, k, top)
                assert not is_end or k == 11
