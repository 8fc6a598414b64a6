"""The clock of the car's loop: one monotonic time for all processes of a machine, and sleeps to an absolute time of it.

`time.perf_counter` is that time: `CLOCK_MONOTONIC` on Linux, the performance counter on Windows, where `time.monotonic`
has steps of 16 ms before Python 3.13, and the absolute time of Mach on macOS.
"""

import ctypes
import os
import sys
import time
import weakref
from typing import Protocol

_SPIN = 0.0005  # s before the end of a sleep that are waited in a loop, because a sleep may end too late
_CLOCK_MONOTONIC = 1
_TIMER_ABSTIME = 1
_PR_SET_TIMERSLACK = 29
_SLACK = 1
_SCHEDULER_STATISTICS = "/proc/thread-self/schedstat"  # run time, wait time and time slices of the thread that opens it


class Clock(Protocol):
    """The interface of the clock of the pacing."""

    def now(self) -> float:
        """Time, s."""

    def sleep_until(self, until: float) -> None:
        """Return at this time, or as soon after it as the system wakes this thread."""

    def spent(self) -> tuple[float, float] | None:
        """Run time of this thread, and time in which it was ready while others ran, s; None if not known."""


class _TimeSpec(ctypes.Structure):
    _fields_ = (("seconds", ctypes.c_long), ("nanoseconds", ctypes.c_long))


class LinuxClock:
    """A clock with `clock_nanosleep` to an absolute time, without the 50 us by which Linux may delay timers.

    It is for the thread that creates it.
    """

    def __init__(self) -> None:
        library = ctypes.CDLL(None, use_errno=True)
        self._sleep = library.clock_nanosleep
        self._sleep.argtypes = (ctypes.c_int, ctypes.c_int, ctypes.POINTER(_TimeSpec), ctypes.c_void_p)
        self._time = _TimeSpec()
        self._pointer = ctypes.pointer(self._time)
        # Threads without real-time priority have a timer slack of 50 us by default.
        library.prctl(_PR_SET_TIMERSLACK, ctypes.c_ulong(_SLACK), 0, 0, 0)
        try:
            self._statistics = os.open(_SCHEDULER_STATISTICS, os.O_RDONLY)
        except OSError:  # a kernel without CONFIG_SCHED_INFO
            self._statistics = -1
        else:
            weakref.finalize(self, os.close, self._statistics)

    def now(self) -> float:
        return time.perf_counter()

    def sleep_until(self, until: float) -> None:
        seconds = int(until)
        self._time.seconds, self._time.nanoseconds = seconds, int(1e9 * (until - seconds))
        self._sleep(_CLOCK_MONOTONIC, _TIMER_ABSTIME, self._pointer, None)

    def spent(self) -> tuple[float, float] | None:
        if self._statistics < 0:
            return None
        # The run time in the file is only updated at ticks.
        return time.thread_time(), 1e-9 * int(os.pread(self._statistics, 96, 0).split()[1])


class SleepingClock:
    """A clock with sleeps of Python, and a loop for the last fraction of a millisecond."""

    def now(self) -> float:
        return time.perf_counter()

    def sleep_until(self, until: float) -> None:
        remaining = until - time.perf_counter() - _SPIN
        if remaining > 0.0:
            time.sleep(remaining)
        while time.perf_counter() < until:
            pass

    def spent(self) -> tuple[float, float] | None:
        return None


def make_clock() -> Clock:
    """The finest clock of this system; on Windows its timer is set to 1 ms until the process ends."""
    if sys.platform == "win32":
        ctypes.WinDLL("winmm").timeBeginPeriod(1)
    elif sys.platform == "linux" and hasattr(os, "sched_getscheduler"):
        return LinuxClock()
    return SleepingClock()
