"""What the commands share: timing of steps, the bar, charts and files."""

from __future__ import annotations

import itertools
import json
import os
import time

import numpy as np
import pytest

from benchmarks.car import manoeuvres
from benchmarks.shared.command import parser_of, pyplot, save_chart, save_rows, watched
from benchmarks.shared.timing import step_time
from mbs import Settings

H, DURATION = 0.01, 0.05  # s


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


def test_the_bar_shows_itself_during_a_first_item_that_takes_long(capsys, monkeypatch):
    monkeypatch.setattr("benchmarks.shared.command.DELAY", 0.05)
    monkeypatch.setattr("mbs.common.progress.DELAY", 0.05)
    for k in watched(range(2)):
        if k == 0:
            time.sleep(0.4)
            assert "0 %" in capsys.readouterr().err
    assert "100 %" in capsys.readouterr().err


def test_a_short_run_shows_no_bar(capsys):
    assert list(watched("abc")) == ["a", "b", "c"]
    assert capsys.readouterr().err == ""


def test_the_same_chart_gives_the_same_bytes(tmp_path, capsys):
    files = [tmp_path / "new" / name for name in ("one.png", "other.png")]
    for file in files:
        figure, ax = pyplot().subplots()
        ax.plot([0.0, 1.0])
        save_chart(figure, file)
    assert files[0].read_bytes() == files[1].read_bytes()
    assert f"written: {files[1]}" in capsys.readouterr().out


def test_rows_are_written_where_asked_for_and_the_conditions_printed(tmp_path, capsys):
    options = parser_of("some", "Text.", chart="a line").parse_args(["--json", str(tmp_path / "rows.json")])
    assert options.chart is None
    save_rows(options.json, "some", [{"h_s": 0.1}], repeats=7, warm_up=2, of="a thing")
    save_rows(None, "some", [])
    written = json.loads(options.json.read_text(encoding="utf-8"))
    assert written["rows"] == [{"h_s": 0.1}]
    assert written["meta"]["of"] == "a thing"
    assert written["meta"]["settings"] == Settings().kernel_fields()
    assert [f.name for f in tmp_path.iterdir()] == ["rows.json"]
    printed = capsys.readouterr().out
    assert "7 runs of each figure after 2 to warm up" in printed
    assert "one run of each figure after 0 to warm up" in printed
    assert f"numpy {np.__version__}" in printed
    assert f"{written['meta']['machine']['processor']}, {os.cpu_count()} cores" in printed
