"""What ends a program from outside: Ctrl-C, `timeout`, a container, a terminal that is closed."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

STOPPING = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
"""Signals that ask a program to end."""

_CRASHES = ("SIGABRT", "SIGBUS", "SIGFPE", "SIGILL", "SIGSEGV", "SIGSYS", "SIGTRAP")
_WINDOWS_CRASH = 0xC0000000
_terminals: list[int] = []
"""Standard output and error, where they were a terminal at first: one that was closed cannot be asked."""


class Stopped(KeyboardInterrupt):
    """A signal other than Ctrl-C asks this program to end.

    Parameters
    ----------
    number : int
        Of the signal.
    """

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = signal.Signals(number)


def heeded() -> list[signal.Signals]:
    """Those of `STOPPING` that this program does not ignore, as under `nohup`."""
    return [number for number in STOPPING if signal.getsignal(number) is not signal.SIG_IGN]


@contextmanager
def stopped_by_signals() -> Iterator[None]:
    """A context in which all that ends programs is met as Ctrl-C is: by an exception, so that what is done is kept."""
    if threading.current_thread() is not threading.main_thread():  # Python has signals in the main thread only
        yield
        return
    numbers = [number for number in heeded() if number != signal.SIGINT]
    before = {number: signal.getsignal(number) for number in numbers}
    _terminals[:] = [place for place in (1, 2) if os.isatty(place)]

    def stop(number: int, _: FrameType | None) -> None:
        if signal.Signals(number).name == "SIGHUP":
            lose_terminals()
        raise Stopped(number)

    try:
        for number in numbers:
            signal.signal(number, stop)
        yield
    finally:
        for number in numbers:
            signal.signal(number, before[number])


def lose_terminals() -> None:
    """After SIGHUP: a terminal that was closed can be written to no more, and tells so more than once."""
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    for place in _terminals:
        os.dup2(os.open(os.devnull, os.O_WRONLY), place)


@contextmanager
def kept_from_children() -> Iterator[None]:
    """A context in which processes and threads are started that this program ends: they never meet `STOPPING`.

    A terminal sends Ctrl-C to all processes of a command. What comes meanwhile is met after the context.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    from multiprocessing import resource_tracker

    before = signal.pthread_sigmask(signal.SIG_BLOCK, STOPPING)  # which what is started inherits
    try:
        resource_tracker.ensure_running()  # Python's own process beside others; it unblocks some at its end
        signal.pthread_sigmask(signal.SIG_BLOCK, STOPPING)
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def ignore_stopping() -> None:
    """Leave it to the program that has started this one to end it: signals of a terminal reach both."""
    for number in STOPPING:
        signal.signal(number, signal.SIG_IGN)


def how_ended(code: int | None, said: str = "") -> str:
    """How a process has ended that was to go on, as the end of a sentence such as ``crashed (SIGSEGV)``.

    Parameters
    ----------
    code : int or None
        As `subprocess` and `multiprocessing` give it.
    said : str, optional
        What it wrote to its standard error; the last line is quoted.
    """
    last = (said.strip().splitlines() or [""])[-1]
    words = f": {last}" if last else ""
    if code is not None and code < 0:
        known = {int(number): number.name for number in signal.Signals}
        name = known.get(-code, f"signal {-code}")
        if name == "SIGKILL":  # no program does that to itself
            return "was killed (SIGKILL), by a user or by the system for want of memory"
        return f"crashed ({name}){words}" if name in _CRASHES else f"was ended by {name}{words}"
    if sys.platform == "win32" and code is not None and code >= _WINDOWS_CRASH:
        return f"crashed (0x{code:08X}){words}"
    return f"ended with exit code {code}{words}"
