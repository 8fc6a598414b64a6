"""Sleeps of the car's clock end at an absolute time, never before it."""

import gc
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

import hosts.simulator.priority as room
from hosts.simulator.clock import Clock, LinuxClock, SleepingClock, make_clock
from hosts.simulator.priority import request_priority
from tests.hosts.simulator.pages import PATIENCE

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
    for past in (clock.now() - 100.0, 0.0):
        clock.sleep_until(past)
    assert abs(clock.now() - time.perf_counter()) < 10.0


@_LINUX
def test_a_clock_that_goes_leaves_no_file_open() -> None:
    clock = LinuxClock()
    if clock.spent() is None:
        pytest.skip("a kernel without CONFIG_SCHED_INFO")
    opened = Path(f"/proc/self/fd/{clock._statistics}")
    assert opened.exists()
    del clock
    gc.collect()
    assert not opened.exists()


@_LINUX
def test_time_that_others_ran_is_distinguished_from_sleep() -> None:
    """On one processor, beside two programs that never sleep: run and wait time differ."""
    mine = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(mine)})
    beside = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(2)]
    try:
        clock = LinuxClock()
        if (before := clock.spent()) is None:
            pytest.skip("a kernel without CONFIG_SCHED_INFO")
        begin, between = clock.now(), before
        while min(between[0] - before[0], between[1] - before[1]) < 0.2 and clock.now() < begin + PATIENCE:
            between = clock.spent() or before
        middle = clock.now()
        clock.sleep_until(middle + 0.5)
        after = clock.spent() or before
    finally:
        os.sched_setaffinity(0, mine)
        for program in beside:
            program.kill()
            program.wait()
    ran, waited = between[0] - before[0], between[1] - before[1]
    assert min(ran, waited) >= 0.2
    assert abs(ran + waited - (middle - begin)) < 0.1  # the system counts at its ticks, of at most 10 ms
    assert after[0] - between[0] < 0.1  # while it slept


def test_the_obtained_priority_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    tried = []
    for name, message in (("_set_fifo", ""), ("_set_nice", ""), ("_lock_memory", "")):
        monkeypatch.setattr(room, name, lambda name=name, message=message: tried.append(name) or message)
    if sys.platform == "win32":
        pytest.skip("the calls of POSIX")
    assert "no priority above normal" in request_priority()
    assert tried == ["_set_fifo", "_set_nice", "_lock_memory"]
    monkeypatch.setattr(room, "_set_nice", lambda: "nice.")
    assert request_priority() == "nice."
    monkeypatch.setattr(room, "_set_fifo", lambda: "first in, first out.")
    monkeypatch.setattr(room, "_lock_memory", lambda: "Locked.")
    assert request_priority() == "first in, first out. Locked."
