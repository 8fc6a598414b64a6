"""Progress bars: drawn on a terminal; in a file, lines at growing intervals."""

import sys
import time
from typing import Any

from tqdm import tqdm

DELAY = 2.0  # s before a bar appears
_GROWTH = 1.5  # ratio of an interval between lines to the previous one
_MAX_INTERVAL = 60.0  # s
_JUDGED = 0.01  # part of the whole after which the remaining time is known


class Bar(tqdm):  # type: ignore[misc]
    """A bar that shows a question mark in place of the remaining time until enough is done to judge it."""

    @property
    def format_dict(self) -> dict[str, Any]:
        values: dict[str, Any] = super().format_dict
        total = values["total"]
        return values | {"rate": 0.0} if total and values["n"] - values["initial"] < _JUDGED * total else values


class _Lines:
    """A stream that writes some states of a bar, and the last one, as lines without control characters."""

    bar: Bar | None = None
    # The interval grows here: tqdm counts some items twice if its own interval changes during an iteration.
    _interval, _due = DELAY, 0.0
    _written: float | None = None  # what was done at the last line

    def write(self, text: str) -> None:
        bar = self.bar
        is_due = bar.n != self._written if bar is not None and bar.disable else time.monotonic() >= self._due
        if (line := text.strip()) and is_due:
            sys.stderr.write(f"{line}\n")
            self._written = self.bar.n if self.bar is not None else None
            self._due, self._interval = (
                time.monotonic() + self._interval,
                min(self._interval * _GROWTH, _MAX_INTERVAL),
            )

    def flush(self) -> None:
        sys.stderr.flush()


def bar(*arguments: Any, **options: Any) -> Bar:
    """A bar on the standard error stream that appears after two seconds. `arguments`, `options`: see `tqdm.tqdm`."""
    options = {"delay": DELAY} | options
    if sys.stderr.isatty():
        return Bar(*arguments, **options)
    lines = _Lines()
    lines.bar = Bar(*arguments, file=lines, ascii=True, mininterval=DELAY, maxinterval=_MAX_INTERVAL, **options)
    return lines.bar
