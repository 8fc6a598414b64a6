"""The data of a study that are sent to its workers, outcomes of runs, and their counts."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hosts.common.numbers import Value
from hosts.fmu.fmu_source import FmuSource
from hosts.study.jobs import Job

if TYPE_CHECKING:
    from hosts.study.measures.study_measure import StudyMeasure

DONE, INCOMPLETE, FAILED = "done", "incomplete", "failed"
"""Status of a run: it has all measures that exist; it lacks some; it has no result."""
ALL = "all limits"
"""Name of the row of variants that keep all limits, in the table of limits."""
MISSING = ", "
"""Separator of the names in the column ``missing``; no name of a measure has it."""
_MAX_COUNTED = 1000  # messages
_MAX_REPORTED = 5


@dataclass(frozen=True)
class Work:
    """A study for a worker."""

    fmu: FmuSource
    """The FMU, of which workers have a copy."""
    guid: str
    sha256: str
    program: str
    """Digest of the program that makes the runs."""
    jobs: tuple[Job, ...]
    parameters: tuple[str, ...]
    measures: tuple[StudyMeasure, ...]
    columns: tuple[str, ...]
    """Names of all measures of the table."""
    signals: tuple[str, ...]
    seed: int = 0
    """Seed of the study."""
    reuse: bool = False
    """Whether an instance of the FMU is used again after a reset."""
    time_limit: float | None = None
    """Longest time of a run, s."""


@dataclass(frozen=True)
class Run:
    """A run of a study."""

    index: int
    """Number of its point times the number of jobs, plus the number of its job."""
    values: Mapping[str, Value]
    """Values of the parameters."""


@dataclass
class Outcome:
    """The outcome of a run: status, measures and messages."""

    status: str = DONE
    reason: str = ""
    measures: dict[str, float] = field(default_factory=dict)
    simulated: float = 0.0
    """Simulated time, s."""
    wall: float = 0.0
    """Elapsed time, s."""
    signals: NDArray[np.float64] | None = None
    """Shape (samples, signals)."""
    units: dict[str, str] = field(default_factory=dict)
    """Units of the measures of a test in a trial run."""
    messages: tuple[str, ...] = ()
    """Messages of the FMU, and notes of a test; each sentence once."""
    missing: tuple[str, ...] = ()
    """Measures that the run did not yield; other NaN are of measures that do not exist in it."""


def seed_of(study_seed: int, point: int) -> int:
    """The seed of all runs of a point: 62 bits that depend on the seed of the study and the number of the point."""
    text = f"{study_seed} {point}".encode()
    return int.from_bytes(hashlib.sha256(text).digest()[:8], "big") >> 2


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
