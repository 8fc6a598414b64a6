"""Sleeps of the car's clock end at an absolute time, never before it."""

from __future__ import annotations

import sys
import time

import pytest

from hosts.simulator.clock import Clock, LinuxClock, SleepingClock, make_clock
from hosts.simulator.priority import ask_for_priority

_LINUX = pytest.mark.skipif(sys.platform != "linux", reason="clock_nanosleep")
_CLOCKS = [pytest.param(LinuxClock, marks=_LINUX), SleepingClock, make_clock]


@pytest.mark.parametrize("kind", _CLOCKS)
def test_sleeps_end_after_their_time_and_not_seconds_after(kind: type[Clock]) -> None:
    clock = kind()
    begin = clock.now()
    for k in range(1, 21):
        clock.sleep_until(begin + 0.003 * k)
        assert clock.now() >= begin + 0.003 * k
    assert clock.now() < begin + 30.0


@pytest.mark.parametrize("kind", _CLOCKS)
def test_a_time_that_has_passed_is_no_sleep(kind: type[Clock]) -> None:
    clock = kind()
    for past in (clock.now() - 100.0, 0.0):
        clock.sleep_until(past)
    assert abs(clock.now() - time.perf_counter()) < 10.0


def test_priority_says_what_was_got(monkeypatch: pytest.MonkeyPatch) -> None:
    import hosts.simulator.priority as room

    tried = []
    for name, words in (("_fifo", ""), ("_nice", ""), ("_keep_memory", "")):
        monkeypatch.setattr(room, name, lambda name=name, words=words: tried.append(name) or words)
    if sys.platform == "win32":
        pytest.skip("the calls of POSIX")
    assert "no priority above the usual" in ask_for_priority()
    assert tried == ["_fifo", "_nice", "_keep_memory"]
    monkeypatch.setattr(room, "_nice", lambda: "nice.")
    assert ask_for_priority() == "nice."
    monkeypatch.setattr(room, "_fifo", lambda: "first in, first out.")
    monkeypatch.setattr(room, "_keep_memory", lambda: "Locked.")
    assert ask_for_priority() == "first in, first out. Locked."
