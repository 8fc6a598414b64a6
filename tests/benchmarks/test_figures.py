"""Figures of the pages are compared with new ones, and a changed figure is reported in one sentence."""

import re

import pytest
from matplotlib.figure import Figure

from ali3.chart_description import read_description
from ali3.charts import save_picture
from benchmarks import figures
from benchmarks.pictures import chart_commands
from benchmarks.shared.figures import RemadeTable, between, differences, read, rows_of, same, written
from benchmarks.shared.pages import DOCS
from hosts.run.plot_panels import draw_table

MADE = "| method | h s | error | ms |\n| --- | --- | --- | --- |\n| a | 0.1 | 2.5 | 9 |\n| b | 0.1 | 1e-05 | 8 |"
PAGE = f"text\n<!-- begin t -->\n{MADE}\n| c | 0.1 | 3 | 7 |\n<!-- end t -->\nThe car takes 0.36 s\nof time.\n"
AGAIN = RemadeTable("docs/x.md", MADE, "t", ("method", "h s"), ("ms",))


def test_a_page_with_the_same_figures_has_no_difference():
    assert differences(AGAIN, PAGE) == []
    assert differences(AGAIN, PAGE.replace("| 9 |", "| 11 |")) == []  # a time
    assert differences(RemadeTable("docs/x.md", "takes 0.36 s of time"), PAGE) == []


def test_only_the_last_of_three_digits_may_be_one_off():
    assert same("0.887", "0.886")
    assert same("-1.20e-05", "-1.21e-05")
    assert same("17.24%", "17.23%")
    assert same("0.52 mm, 1.30e-04", "0.52 mm, 1.31e-04")
    for shown, computed in (("0.887", "0.885"), ("2.5", "2.6"), ("0.887", "0.0886"), ("117", "118"), ("1.00", "-1.00")):
        assert not same(shown, computed)
        assert not same(f"{shown}%", f"{computed}%")
    for shown, computed in (("17.24%", "17.24"), ("17.24%", "17.23 N"), ("2, 12", "2"), (None, "2")):
        assert not same(shown, computed)


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        ("2.5", "2.6", "row a, 0.1: error is 2.6 on the page and 2.5 when it is made again."),
        ("1e-05", "1e-06", "row b, 0.1: error is 1e-06 on the page and 1e-05"),
        ("| b | 0.1 |", "| b | 0.2 |", "has no row b, 0.1."),
        ("begin t", "begin s", "has no row a, 0.1."),
        ("| error |", "| errors |", "error is None on the page"),
    ],
)
def test_an_altered_figure_is_a_sentence(before, after, message):
    assert any(message in line for line in differences(AGAIN, PAGE.replace(before, after)))


def test_a_chart_carries_its_description_and_changed_panels_are_reported(tmp_path):
    """A panel less, another unit, a curve more, a figure of the summary that is another."""

    def drawn(name, panels, load):
        figure = Figure()
        figure.suptitle("a  car's\n drive")
        axes = figure.subplots(1, len(panels) + 1)
        for one, (title, (unit, curves)) in zip(axes, panels.items(), strict=False):
            for curve in curves:
                one.plot([0.0, 1.0], [0.0, 1.0], label=curve)
            one.plot([0.0, 1.0], [0.5, 0.5])  # without a name
            one.set_title(title, loc="left")
            one.set(xlabel="time, s", ylabel=unit)
        draw_table(axes[-1], [("largest wheel load", load), ("distance driven", "15 m")])
        save_picture(figure, tmp_path / name)
        return read_description(tmp_path / name)

    old = drawn("old.png", {"Speed": ("m/s²", ()), "Loads": ("kN", ("FL",)), "Iterations": ("", ())}, "2357 N")
    new = drawn("new.png", {"Speed": ("m/s²", ()), "Loads": ("kN", ("FL", "FR"))}, "2355 N")
    assert old.splitlines()[:3] == [
        "a car's drive",
        "panel Speed; x time, s; y m/s²",
        "panel Loads; x time, s; y kN; curves FL",
    ]
    again = RemadeTable("docs/images/x.png", new, picture=(tmp_path / "new.png").read_bytes())
    gone, drawn_now = (
        "docs/images/x.png shows what is not drawn now: ",
        "docs/images/x.png does not show what is drawn now: ",
    )
    assert differences(again, old) == [
        f"{gone}panel Loads; x time, s; y kN; curves FL",
        f"{gone}panel Iterations; x time, s",
        f"{gone}largest wheel load: 2357 N",
        f"{drawn_now}panel Loads; x time, s; y kN; curves FL, FR",
        f"{drawn_now}largest wheel load: 2355 N",
    ]
    assert differences(again, new) == []
    (message,) = differences(again, "")
    assert message.startswith("docs/images/x.png does not say what it shows; python -m benchmarks.figures --write")


@pytest.mark.parametrize("name", chart_commands.CHARTS)
def test_redrawn_charts_carry_their_description(name):
    page = f"docs/images/{name}"
    assert len(read(page).splitlines()) > 1
    pages = [DOCS.parent / "README.md", *DOCS.glob("*.md")]
    assert any(f"images/{name})" in file.read_text(encoding="utf-8") for file in pages)


def test_a_table_is_written_with_the_new_cells_and_keeps_the_rest():
    other = PAGE.replace("| 2.5 |", "| 7 |").replace("| 9 |", "| 11 |")
    assert written(AGAIN, other) == PAGE.replace("| 9 |", "| 11 |")  # a time is not made
    assert written(AGAIN, PAGE.replace("| b | 0.1 | 1e-05 | 8 |\n", "")).count("| b | 0.1 | 1e-05 | 8 |") == 1
    empty = "text\n<!-- begin t -->\n<!-- end t -->\n"
    assert written(AGAIN, empty) == f"text\n<!-- begin t -->\n{MADE}\n<!-- end t -->\n"
    assert rows_of(written(AGAIN, PAGE.replace("| ms |", "| us |"))) == rows_of(MADE)  # other columns: a new table


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


def test_a_table_that_is_made_without_rows_is_reported():
    result = MADE.rsplit("\n", 2)[0]
    assert differences(RemadeTable("docs/x.md", result, "t", ("method", "h s")), PAGE) == [
        "docs/x.md, table 't': there are no rows when it is made again."
    ]


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
