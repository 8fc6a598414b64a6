"""Runs a standard test with a car, after checking settings and variables."""

from collections.abc import Callable, Mapping, Set
from dataclasses import replace
from typing import TypeAlias

from ali3.columns import some_of
from ali3.units import typeset
from hosts.catalogue.car import TestedCar
from hosts.catalogue.record import StandardTest, TestRecord
from hosts.common.errors import HostError

_MOST_MESSAGES = 10
_MOST_NAMES = 4
_LONGEST = 300

Reason: TypeAlias = str
"""Why a test of a car could not be done: a sentence."""


def settings_of_test(test: StandardTest, values: Mapping[str, float]) -> dict[str, float]:
    """All settings of a test, those of `values` and those by default. `values`: by the names of `test.settings`.

    Raises `HostError` if a name is not known or a value out of its range.
    """
    by_name = {s.name: s for s in test.settings}
    for name, value in values.items():
        if name not in by_name:
            raise HostError(f"The test {test.name} has no setting '{name}'; it has: {', '.join(by_name) or 'none'}.")
        s = by_name[name]
        if not s.lowest <= value <= s.highest:  # nor is a NaN
            unit = f" {typeset(s.unit)}".rstrip()
            raise HostError(
                f"The setting {name} of the test {test.name} is {value:g}{unit}; it must be from {s.lowest:g} to "
                f"{s.highest:g}{unit}."
            )
    return {name: float(values.get(name, s.value)) for name, s in by_name.items()}


def missing_for(test: StandardTest, car: TestedCar, settings: Mapping[str, float]) -> Reason | None:
    """Why a test cannot be done with a car, from what its FMU reports; None if it can."""
    missing = lacking(test, {*car.facts.inputs, *car.facts.outputs, *car.facts.parameters, *car.facts.constants})
    if not missing:
        return test.why_not(car, settings)
    message = " and no ".join(" or ".join(_names(need)) for need in missing)
    reasons = [car.fmu.why_missing(name) for need in missing for name in _names(need)]
    hint = "where it has another name, an alias file says which (--aliases)."
    return f"The FMU {car.path.name} has no {message}; {' '.join(dict.fromkeys(filter(None, reasons))) or hint}"


def lacking(test: StandardTest, there: Set[str]) -> list[str]:
    """What of the needs of a test is not there; an entry ``a | b`` is if one of its names is."""
    return [need for need in test.needs if not there & set(_names(need))]


def _names(need: str) -> list[str]:
    return [name.strip() for name in need.split("|")]


def perform(
    test: StandardTest,
    car: TestedCar,
    settings: Mapping[str, float] | None = None,
    progress: Callable[[float], None] = lambda done: None,
) -> TestRecord:
    """Run a standard test with a car.

    `settings`: those that are not by default; `progress`: called with the part that is done, 0 to 1. Raises `HostError`
    if a setting is wrong, or the car cannot do the test.
    """
    test_settings = settings_of_test(test, settings or {})
    missing = missing_for(test, car, test_settings)
    if missing is not None:
        raise HostError(missing)
    progress(0.0)
    record = test.perform(car, test_settings, progress)
    progress(1.0)
    return replace(record, notes=[*record.notes, *_said(record)])


def _said(record: TestRecord) -> list[str]:
    """Messages of the FMU in which runs, each sentence once."""
    runs: dict[str, list[str]] = {}
    for name, result in record.runs.items():
        for message in dict.fromkeys(" ".join(m.split()) for m in result.messages):
            runs.setdefault(message, []).append(name)
    messages = []
    for message, names in list(runs.items())[:_MOST_MESSAGES]:
        where = "every run" if len(names) == len(record.runs) > 1 else some_of(names, _MOST_NAMES)
        words = message if len(message) <= _LONGEST else f"{message[:_LONGEST]}..."
        messages.append(f"The FMU reported in {where}: {words}")
    if len(runs) > _MOST_MESSAGES:
        messages.append(f"The FMU reported {len(runs) - _MOST_MESSAGES} other messages.")
    return messages
