"""Limits of measures that the user gives, beside those of standards."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from hosts.catalogue.record import TestRecord
from hosts.catalogue.registry import TESTS
from hosts.catalogue.task import Outcome
from hosts.common.errors import HostError
from hosts.common.units import conversion
from hosts.measures.limit_entry import LimitEntry
from hosts.measures.limits import limits_of
from hosts.measures.measure import Limit, Measure


@dataclass(frozen=True)
class GivenLimits:
    """The table ``[limits]`` of a file."""

    file: Path = Path()
    """The file, for messages and for the source of a limit."""
    entries: Mapping[str, LimitEntry] = field(default_factory=dict)
    """By ``TEST.MEASURE``, or the measure alone where one test has it."""

    def of_tests(self, names: list[str]) -> GivenLimits:
        """Those that are not of other tests of the catalogue."""
        other_tests = set(TESTS) - set(names)
        return replace(self, entries={n: e for n, e in self.entries.items() if n.partition(".")[0] not in other_tests})

    def judged(self, outcomes: Mapping[str, Mapping[str, Outcome]]) -> tuple[dict[str, dict[str, Outcome]], list[str]]:
        """The outcomes with these limits, and what is wrong with others of them, each in a sentence.

        `outcomes`: by name of the test and label of the car.

        Notes
        -----
        A measure that has a limit of its standard must keep both.
        """
        units: dict[str, str] = {}
        for test, by_car in outcomes.items():
            for outcome in by_car.values():
                units |= {f"{test}.{m.name}": m.unit for m in _measures(outcome)}
        good: dict[str, LimitEntry] = {}
        limits: dict[str, Limit] = {}
        faults = []
        for name, entry in self.entries.items():
            try:
                limits = limits_of({**good, name: entry}, units, self.file)
            except HostError as error:
                faults.append(str(error))
            else:
                good[name] = entry

        def limited(test: str, m: Measure) -> Measure:
            column = f"{test}.{m.name}"
            if column not in limits:
                return m
            factor = conversion(units[column], m.unit, f"{self.file}: limits.'{column}'")
            converted_limit = replace(
                limits[column], lowest=factor * limits[column].lowest, highest=factor * limits[column].highest
            )
            return replace(m, limit=_both(m.limit, converted_limit))

        judged_outcomes = {
            test: {
                label: replace(o, measures=[limited(test, m) for m in o.measures]) if isinstance(o, TestRecord) else o
                for label, o in by_car.items()
            }
            for test, by_car in outcomes.items()
        }
        return judged_outcomes, faults


def _measures(outcome: Outcome) -> list[Measure]:
    return list(outcome.measures) if isinstance(outcome, TestRecord) else []


def _both(one: Limit | None, other: Limit) -> Limit:
    if one is None:
        return other
    return Limit(f"{one.source}; {other.source}", max(one.lowest, other.lowest), min(one.highest, other.highest))
