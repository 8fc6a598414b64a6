"""Ends child processes of this program, and describes how a child process ended."""

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing import resource_tracker

from ali3.signals import STOPPING

_CRASH_SIGNALS = ("SIGABRT", "SIGBUS", "SIGFPE", "SIGILL", "SIGSEGV", "SIGSYS", "SIGTRAP")
_MIN_WINDOWS_CRASH = 0xC0000000


@contextmanager
def stop_signals_blocked() -> Iterator[None]:
    """Context that blocks the signals of `STOPPING` for processes and threads started in it, which this program ends.

    A terminal sends Ctrl-C to all processes of a command. A signal in the context is delivered after it.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    previous_mask = signal.pthread_sigmask(signal.SIG_BLOCK, STOPPING)  # children inherit the mask
    try:
        resource_tracker.ensure_running()  # Python's own process; this call unblocks SIGINT and SIGTERM
        signal.pthread_sigmask(signal.SIG_BLOCK, STOPPING)
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, previous_mask)


def ignore_stopping() -> None:
    """Ignore the signals of `STOPPING`: the parent process, which a terminal sends them too, ends this one."""
    for number in STOPPING:
        signal.signal(number, signal.SIG_IGN)


def how_ended(code: int | None, message: str = "", call: str = "") -> str:
    """Predicate for the unexpected end of a process, such as ``crashed (SIGSEGV)``.

    `code`: exit code of `subprocess` or `multiprocessing`; `message`: standard error of the process, whose last line
    is quoted; `call`: the last call, such as `` in fmi2DoStep at 0.1 s``.
    """
    last_line = (message.strip().splitlines() or [""])[-1]
    details = f"{call}: {last_line}" if last_line else call
    if code is not None and code < 0:
        signal_names = {int(number): number.name for number in signal.Signals}
        name = signal_names.get(-code, f"signal {-code}")
        if name == "SIGKILL":  # no program does that to itself
            return f"was killed (SIGKILL){call}, by a user or by the system because memory ran out"
        return f"crashed ({name}){details}" if name in _CRASH_SIGNALS else f"was ended by {name}{details}"
    if sys.platform == "win32" and code is not None and code >= _MIN_WINDOWS_CRASH:
        return f"crashed (0x{code:08X}){details}"
    return f"ended with exit code {code}{details}"
