"""Progress bars of long work without a terminal."""

import re
from types import SimpleNamespace

import pytest

from ali3 import bars


def test_lines_count_each_thing_once_and_become_rarer(capsys, monkeypatch):
    now = [0.0]
    monkeypatch.setattr(bars, "DELAY", 2.0)
    monkeypatch.setattr(bars, "time", SimpleNamespace(monotonic=lambda: now[0]))
    monkeypatch.setattr("tqdm.std.time", lambda: now[0])
    for _ in bars.bar(range(40), desc="work"):
        now[0] += 1.0
    lines = capsys.readouterr().err.splitlines()
    counts = [int(re.findall(r"(\d+)/40 ", line)[0]) for line in lines]
    assert counts == [2, 4, 8, 14, 22, 34, 40]  # after 2 s, then waits of 2 s times 1.5, 1.5 squared, ..., each 2 s
    assert not any(character in line for line in lines for character in "\r\x1b")


def test_the_last_line_stands_once(capsys):
    with bars.bar(total=2, delay=0.0) as bar:
        for _ in range(2):
            bar.fp._due = bar.last_print_t = 0.0  # each state is due, the last too
            bar.update()
        bar.fp._due = 0.0
    counts = re.findall(r"(\d)/2 ", capsys.readouterr().err)
    assert counts[-2:] == ["1", "2"]


@pytest.mark.parametrize(("done", "left"), [(0.0, "?"), (1.0, "?"), (49.0, "?"), (50.0, "26:20")])
def test_no_remaining_time_is_told_before_a_hundredth_is_done(done, left):
    """The first of 5000 s may have waited for a start. A fifth was done before."""
    with bars.Bar(total=5000.0, initial=1000.0, bar_format="{remaining} to go") as bar:
        bar.n += done
        assert bars.Bar.format_meter(**bar.format_dict | {"elapsed": 20.0}) == f"{left} to go"
