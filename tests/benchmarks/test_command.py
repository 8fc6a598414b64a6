"""The frame of the commands: options, tables, files, pages; timing of steps, the bar, charts."""

import itertools
import json
import os
import time
from argparse import Namespace
from pathlib import Path

import numpy as np
import pytest

from benchmarks.car import manoeuvres
from benchmarks.shared.command import Part, pyplot, run, save_chart
from benchmarks.shared.pages import table
from mbs import Settings
from mbs.simulation.step_time import step_time

H = 0.01  # s
DURATION = 0.05  # s
ROWS = [{"scene": "a", "h_s": 0.1}, {"scene": "b", "h_s": 0.2}]


def measured(options: Namespace) -> list[dict[str, object]]:
    return [row | {"size": options.size} for row in ROWS if row["scene"] in options.only]


def drawn(rows, file):
    figure, ax = pyplot().subplots()
    ax.plot([row["h_s"] for row in rows])
    save_chart(figure, file)


PARTS = {
    "some": Part(
        "about it",
        measured,
        names=("a", "b"),
        options={
            "size": (2.5, "in m"),
            "against": (Path, "a file"),
            "fast": (False, "a switch"),
            "many": ((1, 2), "n"),
        },
        pages=("page.md",),
        blocks=lambda rows: {"steps": table(rows, {"scene": "", "h_s": "g"})},
        chart=drawn,
        check=lambda rows, options: [f"{row['scene']} is fast" for row in rows if options.fast],
    ),
    "writer": Part("writes", lambda options: print("has written"), rows=False),
}


def test_rows_are_printed_written_drawn_and_put_into_the_page(tmp_path, capsys, monkeypatch):
    page = "x\n<!-- begin steps -->\n<!-- end steps -->\n<!-- begin machine some -->\n<!-- end machine some -->\n"
    (tmp_path / "page.md").write_text(page, encoding="utf-8")
    monkeypatch.setattr("benchmarks.shared.command.DOCS", tmp_path)
    file, chart = tmp_path / "rows.json", tmp_path / "chart.png"
    files = ["--json", str(file), "--chart", str(chart), "--write"]
    assert run("it", "Text.", PARTS, ["some", "--only", "b", "--size", "4", *files]) == 0
    written = json.loads(file.read_text(encoding="utf-8"))
    assert written["rows"] == [{"scene": "b", "h_s": 0.2, "size": 4.0}]
    meta = {"benchmark": "it", "part": "some", "only": ["b"], "size": 4.0, "many": [1, 2], "fast": False}
    assert meta.items() <= written["meta"].items()
    assert written["meta"]["settings"] == Settings().kernel_fields()
    assert chart.read_bytes().startswith(b"\x89PNG")
    printed = capsys.readouterr().out
    assert "steps\n\n| scene | h s |" in printed
    assert f"numpy {np.__version__}" in printed
    assert f"{written['meta']['machine']['processor']}, {os.cpu_count()} cores" in printed
    text = (tmp_path / "page.md").read_text(encoding="utf-8")
    assert "| b | 0.2 |" in text
    assert f"numpy {np.__version__}" in text.partition("machine some")[2]
    assert text.startswith("x\n")
    assert "rows now and had" not in printed
    assert run("it", "Text.", PARTS, ["some", "--write"]) == 0
    assert run("it", "Text.", PARTS, ["some", "--only", "a", "--write"]) == 0
    assert "The table 'steps' has 1 rows now and had 2" in capsys.readouterr().out


def test_rows_of_earlier_runs_are_taken_together(tmp_path, capsys):
    files = [tmp_path / f"{name}.json" for name in "ab"]
    for file in files:
        assert run("it", "Text.", PARTS, ["some", "--only", file.stem, "--json", str(file)]) == 0
    both = tmp_path / "both.json"
    capsys.readouterr()
    assert run("it", "Text.", PARTS, ["some", "--from", *map(str, files), "--json", str(both)]) == 0
    assert [row["scene"] for row in json.loads(both.read_text(encoding="utf-8"))["rows"]] == ["a", "b"]
    assert "| b | 0.2 |" in capsys.readouterr().out


def test_what_is_not_good_ends_with_one_and_wrong_options_with_two(capsys):
    assert run("it", "Text.", PARTS, ["some", "--fast"]) == 1
    assert capsys.readouterr().out.endswith("a is fast\nb is fast\n")
    for arguments, message in (
        (["some", "--size", "-1"], "--size is -1.0; it is a positive number."),
        (["some", "--only", "c"], "invalid choice: 'c'"),
        ([], "required: PART"),
    ):
        with pytest.raises(SystemExit) as ended:
            run("it", "Text.", PARTS, arguments)
        assert ended.value.code == 2
        assert message in capsys.readouterr().err


def test_only_the_steps_are_between_two_looks_at_the_clock():
    ticks = itertools.count()
    system = manoeuvres.system_of("drop")
    assert step_time(system, DURATION, H, 3, lambda: float(next(ticks))) == 1.0
    assert next(ticks) == 2 * 4


def test_inputs_have_their_first_values_before_the_start():
    system = manoeuvres.system_of("drop")
    falls = {"throttle": (np.array([0.0, 0.0, 1.0]), np.array([0.0, 2.0, 0.5]))}
    with pytest.raises(ValueError, match=r"throttle.* is 2 .* t = 0 s"):
        step_time(system, DURATION, H, 1, time.perf_counter, falls)
