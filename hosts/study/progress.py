"""What a study shows while it runs: a bar on a terminal, else a line from time to time, for logs."""

from __future__ import annotations

import sys
import time as clock
from types import TracebackType

from tqdm import tqdm

_BETWEEN = 60.0  # s between lines


class StudyProgress:
    """Counts runs.

    Parameters
    ----------
    runs, done : int
        In all, and those that are done already.
    """

    def __init__(self, runs: int, done: int) -> None:
        self.failed = 0
        self.made = 0
        self._runs, self._before = runs, done
        self._began = self._told = clock.monotonic()
        self._bar = tqdm(total=runs, initial=done, desc="study", unit="run", smoothing=0.05, delay=2.0, disable=None)

    def __enter__(self) -> StudyProgress:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bar.close()

    def __call__(self, made: int, failed: int) -> None:
        """Count runs that have come, and those of them that failed."""
        self.made += made
        self.failed += failed
        self._bar.set_postfix(failed=self.failed, refresh=False)
        self._bar.update(made)
        if self._bar.disable and clock.monotonic() - self._told > _BETWEEN:
            self._told = clock.monotonic()
            print(self._line(), file=sys.stderr, flush=True)

    def _line(self) -> str:
        rate = self.made / (clock.monotonic() - self._began)
        left = self._runs - self._before - self.made
        return (
            f"{self._before + self.made} of {self._runs} runs, {self.failed} failed, {rate:.3g} runs/s, "
            f"{duration(left / rate)} left"
        )


def duration(seconds: float) -> str:
    """A time for a person."""
    if seconds < 100.0:
        return f"{seconds:.2g} s"
    if seconds < 6000.0:
        return f"{seconds / 60.0:.0f} min"
    return f"{seconds / 3600.0:.3g} h" if seconds < 2e5 else f"{seconds / 86400.0:.3g} days"
