"""Progress of a long build, shown in one line on the terminal."""

import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

PATIENCE = 2.0
"""Longer work is reported, s."""
_REDRAW_INTERVAL = 0.5  # s, on a terminal
_REPEAT_INTERVAL = 30.0  # s, in a file


@contextmanager
def watched(tell: Callable[[float], None], then: float) -> Iterator[None]:
    """A context that calls `tell` with its duration, s: after two seconds, and every `then` seconds from there."""
    begin, finished = time.perf_counter(), threading.Event()

    def watch() -> None:
        wait = PATIENCE
        while not finished.wait(wait):
            tell(time.perf_counter() - begin)
            wait = then

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    try:
        yield
    finally:
        finished.set()
        watcher.join()


class ProgressLine:
    """Reports work that takes longer than two seconds.

    On a terminal it is one line that is drawn again and again; in a file it is a line at the beginning, every half a
    minute and at the end.
    """

    def __init__(self) -> None:
        self._stream = sys.stderr
        self._drawn = self._stream.isatty()
        self._done, self._total = 0, 0

    def expect(self, total: int) -> None:
        """Begin to count. `total`: pieces of work to come."""
        self._done, self._total = 0, total

    @contextmanager
    def report_stage(self, what: str, note: str = "") -> Iterator[None]:
        """A context for work that is reported. `what`: the work; `note`: why it may take long."""
        words = f" ({note})" if note else ""

        def tell(lasted: float) -> None:
            line = f"{self._count(1)}{what}, {lasted:.0f} s{words} ..."
            self._say(f"\r\033[K{line}" if self._drawn else line + "\n")

        begin = time.perf_counter()
        try:
            with watched(tell, _REDRAW_INTERVAL if self._drawn else _REPEAT_INTERVAL):
                yield
        finally:
            took = time.perf_counter() - begin
            self._done += 1
            if self._drawn:
                self._say("\r\033[K")
            elif took > PATIENCE:
                self._say(f"{self._count()}{what}: {took:.0f} s\n")

    def _count(self, more: int = 0) -> str:
        return f"[{self._done + more}/{self._total}] " if self._total else ""

    def _say(self, text: str) -> None:
        self._stream.write(text)
        self._stream.flush()
