"""Counts of the outcomes of a running study."""

from collections import Counter

from hosts.study.worker_data import FAILED, INCOMPLETE, Outcome

_MAX_COUNTED = 1000  # messages
_MAX_REPORTED = 5


class Counts:
    """Counts the outcomes of runs."""

    def __init__(self) -> None:
        self.failed = self.incomplete = self.made = 0
        self._messages: Counter[str] = Counter()

    def add(self, outcome: Outcome) -> None:
        """Count a run by its status, and its messages."""
        self.made += 1
        self.failed += outcome.status == FAILED
        self.incomplete += outcome.status == INCOMPLETE
        for message in outcome.messages:
            if message in self._messages or len(self._messages) < _MAX_COUNTED:
                self._messages[message] += 1

    def frequent_messages(self) -> list[str]:
        """The most frequent messages of the runs, a line each."""
        lines = [f"in {n} of {self.made} runs: {message}" for message, n in self._messages.most_common(_MAX_REPORTED)]
        remaining = len(self._messages) - len(lines)
        return [*lines, f"and {remaining} other messages, in the column messages"] if remaining > 0 else lines


def duration(seconds: float) -> str:
    """A duration as text."""
    if seconds < 100.0:
        return f"{seconds:.2g} s"
    if seconds < 6000.0:
        return f"{seconds / 60.0:.0f} min"
    return f"{seconds / 3600.0:.3g} h" if seconds < 2e5 else f"{seconds / 86400.0:.3g} days"
