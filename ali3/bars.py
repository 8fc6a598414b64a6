"""Progress bars: drawn on a terminal; in a file, lines at growing intervals."""

from __future__ import annotations

import sys
import time
from typing import Any

from tqdm import tqdm

DELAY = 2.0  # s before a bar appears
_LATER = 1.5  # ratio of an interval between lines to the one before
_LONGEST = 60.0  # s: longest interval


class _Lines:
    """A stream for a bar: writes some of its states, and the last one, as lines without control characters."""

    bar: tqdm[Any] | None = None
    # The interval grows here: tqdm counts some items twice if its own interval changes during an iteration.
    _apart, _next = DELAY, 0.0

    def write(self, text: str) -> None:
        if (line := text.strip()) and (time.monotonic() >= self._next or (self.bar is not None and self.bar.disable)):
            sys.stderr.write(f"{line}\n")
            self._next, self._apart = time.monotonic() + self._apart, min(self._apart * _LATER, _LONGEST)

    def flush(self) -> None:
        sys.stderr.flush()


def bar(*things: Any, **options: Any) -> tqdm[Any]:
    """A bar on the standard error stream, silent for two seconds. `things`, `options`: of `tqdm.tqdm`."""
    options = {"delay": DELAY} | options
    if sys.stderr.isatty():
        return tqdm(*things, **options)
    lines = _Lines()
    lines.bar = tqdm(*things, file=lines, ascii=True, mininterval=DELAY, maxinterval=_LONGEST, **options)
    return lines.bar
