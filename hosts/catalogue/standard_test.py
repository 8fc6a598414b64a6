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
    """A clause of a standard that a test follows."""

    number: str
    """Such as ``8.2``; empty if only a summary is known."""
    text: str
    """Its requirement, in our words."""
    checked: bool = False
    """Whether it was checked against the text of the standard; otherwise it is from public summaries."""


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
    """Default, in `unit`."""
    unit: str
    text: str
    lowest: float = -np.inf
    """Lower end of the allowed range."""
    highest: float = np.inf
    """Upper end of the allowed range."""


@dataclass(frozen=True)
class Line:
    """A line of a plot; `x`, `y`: shape (n,), NaN in gaps."""

    label: str
    x: NDArray[np.float64]
    y: NDArray[np.float64]


@dataclass(frozen=True)
class Plot:
    """A plot of a test; lines of several cars are drawn into the same."""

    title: str
    """Title, by which plots of several cars are matched."""
    x: str
    """Quantity and unit of the abscissa, such as ``lateral acceleration, m/s²``."""
    y: str
    """Quantity and unit of the ordinate."""
    lines: Sequence[Line]
    log_x: bool = False
    """Whether the abscissa is logarithmic."""
    log_y: bool = False
    """Whether the ordinate is logarithmic."""
    equal: bool = False
    """Whether both axes have the same scale."""


@dataclass(frozen=True)
class TestRecord:
    """The results of a test of one car."""

    __test__ = False  # no test of pytest's

    measures: Sequence[Measure]
    plots: Sequence[Plot]
    runs: Mapping[str, Result]
    """Results of all runs by a short name, with ALi3 names of variables, in SI units."""
    notes: Sequence[str] = field(default_factory=tuple)
    """Sentences on deviations from the request, each with a number and a remedy."""


Perform: TypeAlias = "Callable[[TestedCar, Mapping[str, float], Callable[[float], None]], TestRecord]"
WhyNot: TypeAlias = "Callable[[TestedCar, Mapping[str, float]], str | None]"


def no_reason(car: TestedCar, settings: Mapping[str, float]) -> None:
    """The reason of a test that can be done with every car: None."""


@dataclass(frozen=True)
class StandardTest:
    """A test of the catalogue."""

    __test__ = False  # no test of pytest's

    name: str
    """Name for the command, such as ``step_steer``."""
    title: str
    perform: Perform
    """``perform(car, settings, progress)`` runs the test with values of all `settings`; `progress` is called with the
    fraction done, 0 to 1. Raises `HostError` with the reason if the test cannot be done with the car."""
    standards: tuple[Standard, ...] = ()
    settings: tuple[Setting, ...] = ()
    needs: tuple[str, ...] = ()
    """Variables, by ALi3 names, without which the test cannot be done."""
    why_not: WhyNot = no_reason
    """``why_not(car, settings)`` returns a sentence if the settings do not fit each other or the car, or None."""
