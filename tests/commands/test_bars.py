"""Progress bars of long work without a terminal."""

import re
import time

import pytest

from ali3 import bars


def test_lines_count_each_thing_once_and_become_rarer(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bars, "DELAY", 0.02)
    monkeypatch.setattr(bars._Lines, "_interval", 0.02)
    for _ in bars.bar(range(40), desc="work"):
        time.sleep(0.01)
    lines = capsys.readouterr().err.splitlines()
    counts = [int(re.findall(r"(\d+)/40 ", line)[0]) for line in lines]
    assert counts == sorted(counts)
    assert counts[-1] == 40
    assert 2 < len(lines) < 12  # 0.4 s in waits of 0.02 s times 1.5, 1.5 squared, ...
    assert not any(character in line for line in lines for character in "\r\x1b")
