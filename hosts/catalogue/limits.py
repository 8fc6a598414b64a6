"""Limits of the user for measures, in addition to the limits of standards."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from hosts.catalogue.registry import TESTS
from hosts.catalogue.standard_test import TestRecord
from hosts.catalogue.task import Outcome
from hosts.common.errors import HostError
from hosts.common.units import conversion
from hosts.measures.limits import LimitEntry, limits_of
from hosts.measures.measure import Limit, Measure


@dataclass(frozen=True)
class GivenLimits:
    """The table ``[limits]`` of a file."""

    file: Path = Path()
    """Path of the file, for messages and sources of limits."""
    entries: Mapping[str, LimitEntry] = field(default_factory=dict)
    """Limits by ``TEST.MEASURE``, or by the measure if it is unique."""

    def of_tests(self, names: list[str]) -> GivenLimits:
        """The limits without those of other tests of the catalogue."""
        other_tests = set(TESTS) - set(names)
        return replace(self, entries={n: e for n, e in self.entries.items() if n.partition(".")[0] not in other_tests})

    def apply_to(
        self, outcomes: Mapping[str, Mapping[str, Outcome]]
    ) -> tuple[dict[str, dict[str, Outcome]], list[str]]:
        """The outcomes with these limits, and a sentence on each limit that cannot be applied.

        `outcomes`: outcomes by name of the test and label of the car.

        Notes
        -----
        A measure with a limit of its standard must keep both limits.
        """
        units: dict[str, str] = {}
        for test, by_car in outcomes.items():
            for outcome in by_car.values():
                units |= {f"{test}.{measure.name}": measure.unit for measure in _measures(outcome)}
        valid_entries: dict[str, LimitEntry] = {}
        limits: dict[str, Limit] = {}
        faults = []
        for name, entry in self.entries.items():
            try:
                limits = limits_of({**valid_entries, name: entry}, units, self.file)
            except HostError as error:
                faults.append(str(error))
            else:
                valid_entries[name] = entry

        def limited(test: str, measure: Measure) -> Measure:
            column = f"{test}.{measure.name}"
            if column not in limits:
                return measure
            factor = conversion(units[column], measure.unit, f"{self.file}: limits.'{column}'")
            converted_limit = replace(
                limits[column], lowest=factor * limits[column].lowest, highest=factor * limits[column].highest
            )
            return replace(measure, limit=_intersection(measure.limit, converted_limit))

        limited_outcomes = {
            test: {
                label: replace(o, measures=[limited(test, measure) for measure in o.measures])
                if isinstance(o, TestRecord)
                else o
                for label, o in by_car.items()
            }
            for test, by_car in outcomes.items()
        }
        return limited_outcomes, faults


def _measures(outcome: Outcome) -> list[Measure]:
    return list(outcome.measures) if isinstance(outcome, TestRecord) else []


def _intersection(standard_limit: Limit | None, user_limit: Limit) -> Limit:
    if standard_limit is None:
        return user_limit
    return Limit(
        f"{standard_limit.source}; {user_limit.source}",
        max(standard_limit.lowest, user_limit.lowest),
        min(standard_limit.highest, user_limit.highest),
    )
