"""The data of a study for its workers, sent to each of them once."""

from __future__ import annotations

import hashlib
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
"""How a run ended: every measure that exists is a number; some is none; there is no result."""
ALL = "all limits"  # in the table of limits: variants that keep each of them
MISSING = ", "
"""Between the names in the column ``missing``; no name of a measure has it."""


@dataclass(frozen=True)
class Work:
    """A study for a worker."""

    fmu: FmuSource
    """Workers have a copy of it."""
    guid: str
    sha256: str
    program: str
    """Digest of the program that makes the runs."""
    jobs: tuple[Job, ...]
    parameters: tuple[str, ...]
    measures: tuple[StudyMeasure, ...]
    columns: tuple[str, ...]
    """All measures of the table."""
    signals: tuple[str, ...]
    seed: int = 0
    """Of the study."""
    reuse: bool = False
    """Whether an instance of the FMU is used again after a reset."""
    time_limit: float | None = None
    """s a run may take."""


@dataclass(frozen=True)
class Run:
    """A run of a study."""

    index: int
    """Its point times the number of jobs, and its job."""
    values: Mapping[str, Value]
    """Of the parameters."""


@dataclass
class Outcome:
    """The outcome of a run: status, measures and messages."""

    status: str = DONE
    reason: str = ""
    measures: dict[str, float] = field(default_factory=dict)
    simulated: float = 0.0
    wall: float = 0.0
    """`simulated`, `wall`: s."""
    signals: NDArray[np.float64] | None = None
    """Shape (samples, signals)."""
    units: dict[str, str] = field(default_factory=dict)
    """Of the measures of a test, where it is not yet known which there are."""
    messages: tuple[str, ...] = ()
    """Messages of the FMU, and notes of a test; each sentence once."""
    missing: tuple[str, ...] = ()
    """Measures that there should be and that the run did not yield; other NaN are of measures that it has not."""


def seed_of(study_seed: int, point: int) -> int:
    """The seed of a point, the same for all its runs: 62 bits that depend on the study's seed and the point alone."""
    text = f"{study_seed} {point}".encode()
    return int.from_bytes(hashlib.sha256(text).digest()[:8], "big") >> 2
