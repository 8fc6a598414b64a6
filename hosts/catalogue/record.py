"""Types of a standard test and of its record of measures, notes and plots."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from hosts.driving.result import Result
from hosts.measures.measure import Measure

if TYPE_CHECKING:
    from hosts.catalogue.car import TestedCar


@dataclass(frozen=True)
class Clause:
    """A part of a standard that a test follows."""

    number: str
    """Such as ``8.2``; empty where only a summary is known."""
    text: str
    """What it demands, in our words."""
    checked: bool = False
    """Whether it was read in the text of the standard; else it is from public summaries."""


@dataclass(frozen=True)
class Standard:
    """A standard with its edition, such as ``ISO 4138:2021``."""

    name: str
    title: str
    clauses: tuple[Clause, ...] = ()


@dataclass(frozen=True)
class Setting:
    """A number of a test that a user may change."""

    name: str
    value: float
    """By default, in `unit`."""
    unit: str
    text: str
    lowest: float = -np.inf
    highest: float = np.inf
    """`lowest`, `highest`: of what makes sense."""


@dataclass(frozen=True)
class Line:
    """Points that are joined in a plot; of length n both, NaN where there is none."""

    label: str
    x: NDArray[np.float64]
    y: NDArray[np.float64]


@dataclass(frozen=True)
class Plot:
    """A plot of a test; lines of several cars are drawn into the same."""

    title: str
    """By which plots of several cars are matched."""
    x: str
    y: str
    """`x`, `y`: quantity and unit, such as ``lateral acceleration, m/s²``."""
    lines: Sequence[Line]
    log_x: bool = False
    log_y: bool = False
    """`log_x`, `log_y`: whether the axis is logarithmic."""
    equal: bool = False
    """Whether both axes have the same scale."""


@dataclass(frozen=True)
class TestRecord:
    """The results of a test of one car."""

    __test__ = False  # no test of pytest's

    measures: Sequence[Measure]
    plots: Sequence[Plot]
    runs: Mapping[str, Result]
    """Every run of the FMU by a short name, under our names of variables, in SI units."""
    notes: Sequence[str] = field(default_factory=tuple)
    """Sentences: what was not as asked, with a number and a remedy."""


Perform: TypeAlias = "Callable[[TestedCar, Mapping[str, float], Callable[[float], None]], TestRecord]"
WhyNot: TypeAlias = "Callable[[TestedCar, Mapping[str, float]], str | None]"


def always(car: TestedCar, settings: Mapping[str, float]) -> None:
    """No reason against a test: it fits every car."""


@dataclass(frozen=True)
class StandardTest:
    """A test of the catalogue."""

    __test__ = False  # no test of pytest's

    name: str
    """Of the command, such as ``step_steer``."""
    title: str
    perform: Perform
    """``perform(car, settings, progress)`` does the test with all of `settings`; `progress` is called with the part
    that is done, 0 to 1. It raises `HostError` if the car cannot do it, with what is missing."""
    standards: tuple[Standard, ...] = ()
    settings: tuple[Setting, ...] = ()
    needs: tuple[str, ...] = ()
    """Variables by our names without which the test cannot be done."""
    why_not: WhyNot = always
    """``why_not(car, settings)`` gives a sentence where the settings do not fit each other or the car, else None."""
