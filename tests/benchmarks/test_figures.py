"""Figures of the pages are held against new ones, and one that is altered is told by a sentence."""

from __future__ import annotations

import re

import pytest

from benchmarks import figures
from benchmarks.pages import PAGES
from benchmarks.shared.figures import Again, between, differences, read, rows_of, same

MADE = "| method | h s | error | ms |\n| --- | --- | --- | --- |\n| a | 0.1 | 2.5 | 9 |\n| b | 0.1 | 1e-05 | 8 |"
PAGE = f"text\n<!-- begin t -->\n{MADE}\n| c | 0.1 | 3 | 7 |\n<!-- end t -->\nThe car takes 0.36 s\nof time.\n"
AGAIN = Again("docs/x.md", MADE, "t", ("method", "h s"), ("ms",))


def test_a_page_with_the_same_figures_has_no_difference():
    assert differences(AGAIN, PAGE) == []
    assert differences(AGAIN, PAGE.replace("| 9 |", "| 11 |")) == []  # a time
    assert differences(Again("docs/x.md", "takes 0.36 s of time"), PAGE) == []


def test_only_the_last_of_three_digits_may_be_one_off():
    assert same("0.887", "0.886")
    assert same("-1.20e-05", "-1.21e-05")
    for shown, made in (("0.887", "0.885"), ("2.5", "2.6"), ("0.887", "0.0886"), ("117", "118"), ("1.00", "-1.00")):
        assert not same(shown, made)


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        ("2.5", "2.6", "row a, 0.1: error is 2.6 on the page and 2.5 when it is made again."),
        ("1e-05", "1e-06", "row b, 0.1: error is 1e-06 on the page and 1e-05"),
        ("| b | 0.1 |", "| b | 0.2 |", "has no row b, 0.1."),
        ("begin t", "begin s", "has no row a, 0.1."),
        ("| error |", "| errors |", "error is None on the page"),
    ],
)
def test_an_altered_figure_is_a_sentence(before, after, said):
    assert any(said in line for line in differences(AGAIN, PAGE.replace(before, after)))


def test_an_altered_sentence_is_told():
    again = Again("README.md", "takes 0.36 s of time")
    assert differences(again, PAGE.replace("0.36", "0.29")) == ["README.md does not say: takes 0.36 s of time"]


def test_the_readme_says_what_the_tables_of_the_pages_say():
    made = [*figures.readme(), *figures.instructions()]
    assert [line for again in made for line in differences(again, read(again.page))] == []
    for again in figures.readme():
        altered = re.sub(r"\d", lambda digit: str((int(digit[0]) + 1) % 10), read(again.page))
        assert differences(again, altered)


def test_figures_that_are_made_in_a_moment_are_those_of_the_pages(capsys):
    assert figures.main(["--only", "Table 1"]) == 0
    assert "1 tables and sentences" in capsys.readouterr().out
    with pytest.raises(SystemExit):
        figures.main(["--only", "nothing"])
    assert "no table is called 'nothing'" in capsys.readouterr().err


def test_every_page_with_measured_tables_names_the_commands_that_make_them():
    """Between marks, and with a command or a test by name on the page."""
    without = []
    for page in PAGES:
        text = read(f"docs/{page}")
        for name in re.findall(r"<!-- begin ([^>]*?) -->", text):
            if rows_of(between(text, name)) and not re.search(r"python -m benchmarks\.\w+|`tests/[\w/]+\.py`", text):
                without.append(f"{page}: {name}")
    assert without == []
