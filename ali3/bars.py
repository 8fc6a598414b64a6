"""Bars of what takes a while: drawn on a terminal; elsewhere, such as in a file, a line of each now and then."""

from __future__ import annotations

import sys
import time
from typing import Any

from tqdm import tqdm

_DELAY = 2.0  # s before a bar appears
_LATER = 1.5  # how much later than the last the next line comes
_LONGEST = 60.0  # s between lines


class _Lines:
    """A stream to which a bar draws itself: some drawings and the last are lines without control characters."""

    bar: tqdm[Any] | None = None
    # Chosen here: a bar whose interval changes while it goes through things counts some of them twice.
    _apart, _next = _DELAY, 0.0

    def write(self, text: str) -> None:
        if (line := text.strip()) and (time.monotonic() >= self._next or (self.bar is not None and self.bar.disable)):
            sys.stderr.write(f"{line}\n")
            self._next, self._apart = time.monotonic() + self._apart, min(self._apart * _LATER, _LONGEST)

    def flush(self) -> None:
        sys.stderr.flush()


def bar(*things: Any, **options: Any) -> tqdm[Any]:
    """A bar on the standard error stream, silent for two seconds. `things`, `options`: of `tqdm.tqdm`."""
    options = {"delay": _DELAY} | options
    if sys.stderr.isatty():
        return tqdm(*things, **options)
    lines = _Lines()
    lines.bar = tqdm(*things, file=lines, ascii=True, mininterval=_DELAY, maxinterval=_LONGEST, **options)
    return lines.bar
