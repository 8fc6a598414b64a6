"""The progress bar appears only when a run takes a while."""

import io
import math
import sys

import pytest

from ali3.bars import DELAY
from mbs.common.progress import Progress, progress_for


@pytest.fixture
def bar_after(capsys):
    def shown(seconds, delay=DELAY):
        now = [0.0]
        with Progress(delay, lambda: now[0]) as bar:
            now[0] = seconds
            bar.update(0.25)
        return capsys.readouterr().err

    return shown


def test_a_short_run_is_silent(bar_after):
    assert bar_after(1.9) == ""


def test_a_long_run_shows_its_share(bar_after):
    text = bar_after(4.0)
    assert " 25 %" in text
    assert " left" in text
    assert text.endswith("\n")


def test_no_bar_when_switched_off(bar_after):
    assert bar_after(1e6, delay=math.inf) == ""
    assert isinstance(progress_for(False), Progress)


@pytest.mark.parametrize("choice", [None, True])
def test_the_bar_goes_to_the_error_stream(choice, capsys):
    with progress_for(choice) as bar:
        bar.update(1.0)
    captured = capsys.readouterr()
    assert captured.out == ""
    assert bool(captured.err) is (choice is True)


@pytest.mark.parametrize("terminal", [True, False])
def test_a_bar_that_comes_by_itself_is_for_terminals_and_lines_are_for_files(terminal, monkeypatch):
    class Stream(io.StringIO):
        def isatty(self):
            return terminal

    now, stream = [0.0], Stream()
    monkeypatch.setattr(sys, "stderr", stream)
    with Progress(DELAY, lambda: now[0], everywhere=False) as bar:
        now[0] = 4.0
        bar.update(0.25)
        bar.update(0.26)
    assert ("\r" in stream.getvalue()) is terminal
    lines = stream.getvalue().splitlines()
    assert terminal or [line[:4] for line in lines] == ["25 %", "26 %"]  # the first, and the last when it ends
