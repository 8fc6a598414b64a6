"""A table of text: what a line, a cell and a number is."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ali3.errors import TableError
from ali3.tables import TextTable, cells_of, is_number


def table(folder: Path, text: str | bytes, **options: Any) -> TextTable:
    file = folder / "t.csv"
    file.write_bytes(text.encode() if isinstance(text, str) else text)
    return TextTable(file, TableError, **options)


@pytest.mark.parametrize(
    "text",
    [
        "time [s],u [m/s]\n0,1.5\n-2e-3,.25\n",
        "\ufefftime [s];u [m/s]\r\n0;1,5\r\n-2e-3;,25\r\n",
        "time [s]\tu [m/s]\n0\t1,5\n-0,002\t,25\n",
        "# of a logger\n\n time [s] \tu [m/s]\n0\t1.5\n # between\n-0.002\t+0.25",
        '"time [s]","u [m/s]"\n"0", "1.5"\n-0.002,0.25\n\n',
    ],
)
def test_forms_of_one_table(tmp_path, text):
    actual = table(tmp_path, text, units=True)
    assert (actual.names, actual.units) == (["time", "u"], {"time": "s", "u": "m/s"})
    assert np.array_equal(actual.values(), [[0.0, 1.5], [-0.002, 0.25]])


def test_a_cell_may_hold_the_mark_and_a_name_keeps_its_brackets(tmp_path):
    actual = table(tmp_path, 'time [s],"wheel[1], load [N]"\n0,1\n')
    assert actual.names == ["time [s]", "wheel[1], load [N]"]
    assert not actual.units
    assert table(tmp_path, 'a,"b;c"\n1,2\n').names == ["a", "b;c"]
    assert table(tmp_path, "a\n1\n", units=True).units == {}


@pytest.mark.parametrize(
    ("above", "known", "names"),
    [
        ("# time [s],u [m/s]\n", ("time",), ["time", "u"]),
        ("#made by A, B\n# time [s], u [m/s]\n# ----\n", ("time",), ["time", "u"]),
        ("# TIME [s]; u [m/s]\n", ("time",), ["TIME", "u"]),
        ("# a b\n", (), ["a", "b"]),
    ],
)
@pytest.mark.parametrize("headed", [True, None])
def test_the_heading_may_be_a_comment(tmp_path, above, known, names, headed):
    actual = table(tmp_path, above + "0,1\n1,2\n", units=True, headed=headed, known=known)
    assert actual.names == names
    assert actual.values().tolist() == [[0.0, 1.0], [1.0, 2.0]]


def test_other_comments_and_numbers_are_no_heading(tmp_path):
    text = "# by Smith, Monza\n0,1\n1,2\n"
    assert table(tmp_path, text, headed=None, known=("x", "y")).names == []
    with pytest.raises(TableError, match="line 2: '0' is a number; above the first values there must be a heading"):
        table(tmp_path, text, known=("time",))


def test_every_so_many_lines_and_one_that_is_cut(tmp_path):
    text = "n\n" + "".join(f"{k}\n" for k in range(10)) + "99"
    assert table(tmp_path, text).values()[-1] == 99.0
    assert table(tmp_path, text, whole=True).values()[-1] == 9.0
    assert table(tmp_path, text).values(every=4).ravel().tolist() == [0.0, 4.0, 8.0]


def test_comments_have_their_lines(tmp_path):
    actual = table(tmp_path, "# start: a=1\nt\n0\n  # end\n")
    assert actual.comments == [(1, "# start: a=1")]
    assert [row.line for row in actual.rows()] == [3]
    assert actual.comments == [(1, "# start: a=1"), (4, "# end")]


def test_a_table_without_names(tmp_path):
    assert table(tmp_path, "0 1\n2 3\n", headed=False).values().tolist() == [[0.0, 1.0], [2.0, 3.0]]
    assert table(tmp_path, "0,1\n2,3\n", headed=None).names == []
    assert table(tmp_path, "x,y\n2,3\n", headed=None).names == ["x", "y"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "t.csv contains no values; it needs a heading and at least one row."),
        ("a\n", "t.csv contains no values; it needs a heading and at least one row."),
        ("a,a\n1,1\n", "t.csv has the column 'a' twice."),
        ("a,b\n\n1\n", "t.csv, line 3: 1 values where the heading has 2 columns."),
        ("a,b\n1,5,2,5\n", "t.csv, line 2: 4 values where the heading has 2 columns; decimal marks must be points."),
        ("a,b\n1,2 m\n", "t.csv, line 2, column 'b': '2 m' is not a number."),
        ("a,b\n1,-inf\n", "t.csv, line 2, column 'b': '-inf' is not a finite number."),
        ("a,b\n1,1e999\n", "t.csv, line 2, column 'b': '1e999' is not a finite number."),
        ("a;b\n1;1.234,5\n", "t.csv, line 2, column 'b': '1.234,5' is not a number."),
        ("a\tb\n1\t1,5,5\n", "t.csv, line 2, column 'b': '1,5,5' is not a number."),
        ('a,b\n1,"2\n', "t.csv, line 2: this is not a line of a CSV file: unexpected end of data."),
        (f"a\n{1001 * '1'}\n", "t.csv, line 2: a cell has 1001 characters; a number or a name has at most 1000."),
        (b"a\n1\0\n", "t.csv is not text: there is a zero byte in line 2."),
        (b"a\n\xff\n", "t.csv is not text in UTF-8; its fault is at about line 1."),
    ],
)
def test_an_invalid_table_is_refused(tmp_path, text, message):
    with pytest.raises(TableError) as refusal:
        table(tmp_path, text).values()
    assert str(refusal.value) == f"{tmp_path}/{message}"


def test_numbers_are_those_of_decimal_digits():
    assert [is_number(c) for c in ("1", "-.5e3", "1_0", "\uff11", "0x1", "", "nan", "1,5")] == [True] * 2 + [False] * 6
    assert is_number("1,5", decimal=",")
    assert is_number("nan", finite=False)
    assert cells_of(' a ,"b ""c"", d", e\t', ",") == ["a", 'b "c", d', "e"]
