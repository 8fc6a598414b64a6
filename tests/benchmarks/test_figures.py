"""Figures of the pages are those of their commands, and each figure of the README is held."""

import re

import pytest

from benchmarks import figures
from benchmarks.pictures import chart_commands
from benchmarks.shared.figures import between, differences, read, rows_of
from benchmarks.shared.pages import DOCS


@pytest.mark.parametrize("name", chart_commands.CHARTS)
def test_redrawn_charts_carry_their_description(name):
    page = f"docs/images/{name}"
    assert len(read(page).splitlines()) > 1
    pages = [DOCS.parent / "README.md", *DOCS.glob("*.md")]
    assert any(f"images/{name})" in file.read_text(encoding="utf-8") for file in pages)


def test_figures_of_the_readme_agree_with_the_tables_of_the_pages():
    result = [*figures.readme_sentences(), *figures.instruction_sentence()]
    assert [line for again in result for line in differences(again, read(again.page))] == []


def test_each_figure_of_the_readme_is_held():
    """A digit at a time, all others as they are."""
    for again in figures.readme_sentences():
        page, figure = (" ".join(text.split()) for text in (read(again.page), again.text))
        assert page.count(figure) == 1
        digits = [page.index(figure) + found.start() for found in re.finditer(r"\d", figure)]
        assert digits
        for k in digits:
            altered = f"{page[:k]}{(int(page[k]) + 1) % 10}{page[k + 1 :]}"
            assert differences(again, altered) == [f"README.md does not say: {again.text}"]


def test_figures_that_are_made_in_a_moment_are_those_of_the_pages(capsys):
    assert figures.main(["--only", "Table 1"]) == 0
    assert "1 tables, sentences and charts" in capsys.readouterr().out
    with pytest.raises(SystemExit):
        figures.main(["--only", "nothing"])
    assert "no table is called 'nothing'" in capsys.readouterr().err


def test_every_page_with_measured_tables_names_the_commands_that_make_them():
    """Between marks, and with a command or a test by name on the page."""
    without = []
    for page in sorted(set(DOCS.glob("*.md")) - {DOCS / "system_file.md"}):  # its table of sensors is no measurement
        text = page.read_text(encoding="utf-8")
        for name in re.findall(r"<!-- begin ([^>]*?) -->", text):
            if rows_of(between(text, name)) and not re.search(r"python -m benchmarks\.\w+|`tests/[\w/]+\.py`", text):
                without.append(f"{page.name}: {name}")
    assert without == []
