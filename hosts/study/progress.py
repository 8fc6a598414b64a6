"""What a study shows while it runs: a bar on a terminal, else a line from time to time, for logs."""

from __future__ import annotations

import sys
import time as clock
from collections import Counter
from collections.abc import Sequence

from tqdm import tqdm

from hosts.common.closing import Closing
from hosts.study.work import FAILED, INCOMPLETE, Outcome

_BETWEEN = 60.0  # s between lines
_MOST_SAID = 1000  # messages that are counted
_TOLD = 5


class StudyProgress(Closing):
    """Counts runs. `runs`, `done`: in all, and those that are done already."""

    def __init__(self, runs: int, done: int) -> None:
        self.failed = 0
        self.incomplete = 0
        self.made = 0
        self._said: Counter[str] = Counter()
        self._runs, self._before = runs, done
        self._began = self._told = clock.monotonic()
        self._bar = tqdm(total=runs, initial=done, desc="study", unit="run", smoothing=0.05, delay=2.0, disable=None)

    def close(self) -> None:
        """Take the bar away."""
        self._bar.close()

    def __call__(self, outcomes: Sequence[Outcome]) -> None:
        """Count runs that have come, those of them that failed, and what was said in them."""
        self.made += len(outcomes)
        self.failed += sum(outcome.status == FAILED for outcome in outcomes)
        self.incomplete += sum(outcome.status == INCOMPLETE for outcome in outcomes)
        for message in (m for outcome in outcomes for m in outcome.messages):
            if message in self._said or len(self._said) < _MOST_SAID:
                self._said[message] += 1
        self._bar.set_postfix(failed=self.failed, refresh=False)
        self._bar.update(len(outcomes))
        if self._bar.disable and clock.monotonic() - self._told > _BETWEEN:
            self._told = clock.monotonic()
            print(self._line(), file=sys.stderr, flush=True)

    def said(self) -> list[str]:
        """What was said in most of the runs."""
        lines = [f"in {n} of {self.made} runs: {message}" for message, n in self._said.most_common(_TOLD)]
        more = len(self._said) - len(lines)
        return [*lines, f"and {more} other messages, in the column messages"] if more > 0 else lines

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
