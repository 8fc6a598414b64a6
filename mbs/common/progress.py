"""Progress bar on a terminal for long runs; plain lines if the output is not a terminal."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

from ali3 import bars

_FORM = "{percentage:3.0f} % {bar:40} {remaining} left"


class Progress:
    """A bar on the standard error stream, or lines; silent until `delay` seconds have passed.

    `delay`: time before the bar appears, s; `clock`: monotone time, s; `everywhere`: whether the bar is also written to
    a stream that is not a terminal, with control characters.
    """

    def __init__(
        self, delay: float, clock: Callable[[], float] = time.perf_counter, *, everywhere: bool = True
    ) -> None:
        self._clock, self._from = clock, clock() + delay
        self._everywhere = everywhere
        self._bar: bars.Bar | None = None

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()

    def update(self, fraction: float) -> None:
        """Show the completed fraction of the run, from 0 to 1."""
        if self._bar is None:
            if self._clock() < self._from:
                return
            if self._everywhere:
                self._bar = bars.Bar(total=1.0, initial=fraction, bar_format=_FORM)
            else:
                self._bar = bars.bar(total=1.0, initial=fraction, bar_format=_FORM, delay=0.0)
        self._bar.update(fraction - self._bar.n)


class Callback(Progress):
    """Progress that calls a function of the completed fraction."""

    def __init__(self, function: Callable[[float], None]) -> None:
        super().__init__(math.inf)
        self._function = function

    def update(self, fraction: float) -> None:
        self._function(fraction)


def progress_for(choice: bool | Callable[[float], None] | None) -> Progress:
    """Make the progress display of a run.

    `choice`: None: after two seconds, as lines without a terminal; True: a bar at once; False: none; or a function of
    the completed fraction.
    """
    if callable(choice):
        return Callback(choice)
    if choice is None:
        return Progress(bars.DELAY, everywhere=False)
    return Progress(0.0 if choice else math.inf)
