"""Counts of the outcomes of a study while it runs."""

from collections import Counter

from hosts.study.worker_data import FAILED, INCOMPLETE, Outcome

_MOST_SAID = 1000  # messages that are counted
_TOLD = 5


class Counts:
    """Counts the outcomes of runs."""

    def __init__(self) -> None:
        self.failed = self.incomplete = self.made = 0
        self._said: Counter[str] = Counter()

    def add(self, outcome: Outcome) -> None:
        """Count a run, whether it failed, and what was said in it."""
        self.made += 1
        self.failed += outcome.status == FAILED
        self.incomplete += outcome.status == INCOMPLETE
        for message in outcome.messages:
            if message in self._said or len(self._said) < _MOST_SAID:
                self._said[message] += 1

    def said(self) -> list[str]:
        """The most frequent messages of the runs."""
        lines = [f"in {n} of {self.made} runs: {message}" for message, n in self._said.most_common(_TOLD)]
        remaining = len(self._said) - len(lines)
        return [*lines, f"and {remaining} other messages, in the column messages"] if remaining > 0 else lines


def duration(seconds: float) -> str:
    """A duration as text."""
    if seconds < 100.0:
        return f"{seconds:.2g} s"
    if seconds < 6000.0:
        return f"{seconds / 60.0:.0f} min"
    return f"{seconds / 3600.0:.3g} h" if seconds < 2e5 else f"{seconds / 86400.0:.3g} days"
