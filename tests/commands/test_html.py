"""HTML reports: one frame and one style sheet for all, and escaped texts."""

import re
from pathlib import Path

import html5lib
import pytest
from lxml import etree
from matplotlib.figure import Figure

from ali3 import html_elements
from ali3.chart_description import read_description, save_figure
from ali3.charts import Drawing, drawing
from ali3.html_elements import element, picture, table

ROOT = Path(__file__).parents[2]
FRAME = re.compile(r"<!doctype|<style|<body|\bfont-family:|max-width: \d+em", re.IGNORECASE)


def test_a_table_has_its_texts() -> None:
    result = table("", ("a", "<b>"), [("heading",), ("row", "<i>&"), ("other", element("td", "mine"))], 'x"')
    page = html_elements.document("<b>", [result])
    assert page.count("<style>") == 1
    tree = html5lib.parse(page, namespaceHTMLElements=False)
    assert tree.findtext("head/title") == "<b>"
    actual = [[(cell.tag, cell.get("scope"), cell.text) for cell in row] for row in tree.iter("tr")]
    assert actual == [
        [("th", "col", "a"), ("th", "col", "<b>")],
        [("th", "colgroup", "heading")],
        [("th", "row", "row"), ("td", None, "<i>&")],
        [("th", "row", "other"), ("td", None, "mine")],
    ]


def test_a_table_with_a_caption_is_a_region_of_its_name() -> None:
    tree = html5lib.parse(html_elements.document("", [table("a & b", ("c",), [])]), namespaceHTMLElements=False)
    assert [caption.text for caption in tree.iter("caption")] == ["a & b"]
    assert [part.get("aria-label") for part in tree.iter("div") if part.get("role") == "region"] == ["a & b"]


def test_a_picture_is_in_the_page() -> None:
    tree = html5lib.parse(
        html_elements.document("", [picture(Drawing(b"<svg/>", 'a "b"', (3, 2)))]), namespaceHTMLElements=False
    )
    (image,) = tree.iter("img")
    assert (image.get("alt"), image.get("src")) == ('a "b"', "data:image/svg+xml;base64,PHN2Zy8+")
    assert (image.get("width"), image.get("height")) == ("3", "2")


def test_a_drawing_has_a_description(tmp_path: Path) -> None:
    for message, title in (("a < b\x07", "a < b\ufffd"), ("", "A drive & more")):
        figure = Figure()
        figure.suptitle("A drive & more")
        axes = figure.subplots()
        axes.plot([0.0, 1.0], label="measured")
        axes.set(title="speed", xlabel="time, s")
        drawn = drawing(figure, message)
        assert drawn.words == (message or title), "a figure without a message has its title as alternative text"
        file = drawn.write(tmp_path / "a.svg")
        tree = etree.parse(file)
        assert (tree.getroot().get("role"), tree.findtext("{*}title")) == ("img", title)
        assert read_description(file) == "A drive & more\npanel speed; x time, s; curves measured"


def test_no_other_room_has_a_frame_or_style_sheet_of_its_own() -> None:
    known = {"ali3/html.py", "viewer/notebook.py", "fmu_src/description/documentation.py"}
    files = [f for room in ("ali3", "mbs", "fmu_src", "hosts") for f in (ROOT / room).rglob("*.py")]
    results = {f.relative_to(ROOT).as_posix() for f in files if FRAME.search(f.read_text(encoding="utf-8"))}
    assert results <= known, results - known


@pytest.mark.parametrize("name", ["a.png", "a"])
def test_names_of_files_are_texts_of_a_chart_whatever_they_are(name: str, tmp_path: Path) -> None:
    """What looks like a formula, and a byte that is no character; without a suffix it is a PNG."""
    figure = Figure()
    figure.suptitle(r"x$\foo$_y" "\udcff")
    figure.subplots().semilogy([1.0, 1000.0], label="$a$ and $b")
    save_figure(figure, tmp_path / name)
    assert (tmp_path / name).read_bytes().startswith(b"\x89PNG")
    assert read_description(tmp_path / name) == "x$\\foo$_y\ufffd\ncurves $a$ and $b"
    (label,) = [t for t in figure.axes[0].get_yticklabels() if t.get_position()[1] == 100.0]
    assert label.get_parse_math()
