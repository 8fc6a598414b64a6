"""Handles signals that end a program: Ctrl-C, `timeout`, a stopped container, a closed terminal."""

import os
import signal
import threading
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

STOPPING = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
"""Signals that ask a program to end."""

_terminals: list[int] = []
"""Those of standard output and error that were a terminal at the start; a closed one cannot be recognised."""


class Stopped(KeyboardInterrupt):
    """A signal other than Ctrl-C asks this program to end."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = signal.Signals(number)


def heeded() -> list[signal.Signals]:
    """Signals of `STOPPING` that this program does not ignore, as it does under `nohup`."""
    return [number for number in STOPPING if signal.getsignal(number) is not signal.SIG_IGN]


@contextmanager
def handled(stop: Callable[[signal.Signals, Any], None], numbers: Collection[signal.Signals]) -> Iterator[None]:
    """Context in which signals call `stop` with their number and previous handler, which is restored at its end."""
    previous_handlers = {number: signal.getsignal(number) for number in numbers}

    def handle(number: int, _: FrameType | None) -> None:
        if number == getattr(signal, "SIGHUP", None):
            _replace_terminals()
        stop(signal.Signals(number), previous_handlers[signal.Signals(number)])

    try:
        for number in numbers:
            signal.signal(number, handle)
        yield
    finally:
        for number in numbers:
            signal.signal(number, previous_handlers[number])


@contextmanager
def stopped_by_signals() -> Iterator[None]:
    """Context in which signals that end programs raise an exception, as Ctrl-C does, so that results can be stored."""
    if threading.current_thread() is not threading.main_thread():  # Python handles signals only in the main thread
        yield
        return
    _terminals[:] = [descriptor for descriptor in (1, 2) if os.isatty(descriptor)]

    def stop(number: signal.Signals, _: object) -> None:
        raise Stopped(number)

    with handled(stop, [number for number in heeded() if number != signal.SIGINT]):
        yield


def _replace_terminals() -> None:
    """Redirect output to a closed terminal to the null device, and ignore further SIGHUP."""
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    for descriptor in _terminals:
        os.dup2(os.open(os.devnull, os.O_WRONLY), descriptor)
