"""The page of an experiment: links to its sections, and plots that are drawn once."""

from pathlib import Path

import html5lib
import pytest
from matplotlib import pyplot as plt
from matplotlib.figure import Figure

from ali3.charts import Drawing, drawing
from hosts.experiment.report import NOTE, Plots, Section, page, paragraph

pytestmark = pytest.mark.drawn


def figure_of(count: int) -> Figure:
    figure, axes = plt.subplots(figsize=(4.0, 3.0), layout="constrained")
    axes.plot(range(count), ".", rasterized=True)
    return figure


def test_links_end_at_the_sections_of_their_titles() -> None:
    sections = [Section("A & b", [paragraph("first", NOTE)]), Section("A b", ["second"], "named"), Section("c", [])]
    tree = html5lib.parse(page("Title", [paragraph("fact")], sections, "foot"), namespaceHTMLElements=False)
    links = {link.get("href"): link.text for link in tree.iter("a")}
    titles = {f"#{part.get('id')}": part.findtext("h2") for part in tree.iter("section")}
    assert links == titles == {"#section-1": "A & b", "#named": "A b", "#section-3": "c"}
    assert [message.text for message in tree.iter("p")][:3] == ["fact", "first", "foot"]
    assert next(p.text for p in reversed([*tree.iter("p")])).partition(", by ALi3 ")[1]


def test_a_figure_is_laid_out_and_drawn_once(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn = []
    draw = Figure.draw
    monkeypatch.setattr(Figure, "draw", lambda self, renderer: (drawn.append(1), draw(self, renderer)))
    actual = drawing(figure_of(3), "words")
    assert len(drawn) == 1
    assert actual.size == (384, 288)
    assert actual.svg == drawing(figure_of(3), "words").svg
    assert actual.svg != drawing(figure_of(4), "words").svg


def test_plots_stand_in_the_page_and_in_the_folder(tmp_path: Path) -> None:
    figure = Plots(tmp_path / "plots").add(Drawing(b"<svg/>", "words", (3, 2)), "01_a/b (c)")
    assert [file.name for file in (tmp_path / "plots").iterdir()] == ["01_a_b_c.svg"]
    assert figure[0].get("alt") == "words"
