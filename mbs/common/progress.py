"""A progress bar on the terminal for runs that take a while."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from types import TracebackType
from typing import TextIO

DELAY = 2.0  # s of wall time before a bar appears by itself
WIDTH = 40


class Progress:
    """Bar on a text stream; silent until `delay` seconds have passed.

    Parameters
    ----------
    delay : float
        Seconds before the bar appears.
    stream : text stream, optional
        Where it is drawn; the standard error stream by default.
    clock : callable
        Seconds, monotone.
    """

    def __init__(
        self, delay: float, stream: TextIO | None = None, clock: Callable[[], float] = time.perf_counter
    ) -> None:
        self._stream = sys.stderr if stream is None else stream
        self._clock = clock
        self._delay = delay
        self._start = clock()
        self._shown = False

    def __enter__(self) -> Progress:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._shown:
            self._stream.write("\n")
            self._stream.flush()

    def update(self, share: float) -> None:
        """Show that `share` (0 to 1) of the run is done."""
        elapsed = self._clock() - self._start
        if elapsed < self._delay:
            return
        self._shown = True
        filled = int(WIDTH * share)
        left = elapsed * (1.0 - share) / share if share > 0.0 else 0.0
        self._stream.write(f"\r[{'#' * filled}{'.' * (WIDTH - filled)}] {100 * share:3.0f} %, {left:.0f} s left ")
        self._stream.flush()


class Callback(Progress):
    """Hands every update to a function."""

    def __init__(self, function: Callable[[float], None]) -> None:
        super().__init__(0.0)
        self._function = function

    def update(self, share: float) -> None:
        self._function(share)


def progress_for(choice: bool | Callable[[float], None] | None) -> Progress:
    """Bar of a run: None after two seconds, True at once, False never; a function receives the share done."""
    if callable(choice):
        return Callback(choice)
    if choice is None:
        return Progress(DELAY)
    return Progress(0.0 if choice else float("inf"))
