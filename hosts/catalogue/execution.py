"""Runs a standard test with a car after a check of settings and variables."""

from collections.abc import Callable, Mapping, Set
from dataclasses import replace
from typing import TypeAlias

from ali3.columns import some_of
from ali3.units import typeset
from hosts.catalogue.car import TestedCar
from hosts.catalogue.standard_test import StandardTest, TestRecord
from hosts.common.errors import HostError

_MAX_MESSAGES = 10
_MAX_NAMES = 4
_MAX_MESSAGE_LENGTH = 300

Reason: TypeAlias = str
"""A sentence on the reason why a test of a car cannot be done."""


def settings_of_test(test: StandardTest, values: Mapping[str, float]) -> dict[str, float]:
    """All settings of a test, by default or of `values`.

    Raises `HostError` if a name is unknown, or a value is out of its range.
    """
    by_name = {s.name: s for s in test.settings}
    for name, value in values.items():
        if name not in by_name:
            raise HostError(f"The test {test.name} has no setting '{name}'; it has: {', '.join(by_name) or 'none'}.")
        s = by_name[name]
        if not s.lowest <= value <= s.highest:  # also for a NaN
            unit = f" {typeset(s.unit)}".rstrip()
            raise HostError(
                f"The setting {name} of the test {test.name} is {value:g}{unit}; it must be from {s.lowest:g} to "
                f"{s.highest:g}{unit}."
            )
    return {name: float(values.get(name, s.value)) for name, s in by_name.items()}


def reason_against(test: StandardTest, car: TestedCar, settings: Mapping[str, float]) -> Reason | None:
    """Why a test cannot be done with a car, from what its FMU reports; None if it can."""
    unmet = unmet_needs(test, {*car.facts.inputs, *car.facts.outputs, *car.facts.parameters, *car.facts.constants})
    if not unmet:
        return test.why_not(car, settings)
    message = " and no ".join(" or ".join(_alternatives(need)) for need in unmet)
    reasons = [car.fmu.why_missing(name) for need in unmet for name in _alternatives(need)]
    hint = "if it has another name, an alias file says which (--aliases)."
    return f"The FMU {car.path.name} has no {message}; {' '.join(dict.fromkeys(filter(None, reasons))) or hint}"


def unmet_needs(test: StandardTest, variables: Set[str]) -> list[str]:
    """Needs of a test that variables do not meet; the need ``a | b`` is met by one of both."""
    return [need for need in test.needs if not variables & set(_alternatives(need))]


def _alternatives(need: str) -> list[str]:
    return [name.strip() for name in need.split("|")]


def perform(
    test: StandardTest,
    car: TestedCar,
    settings: Mapping[str, float] | None = None,
    progress: Callable[[float], None] = lambda done: None,
) -> TestRecord:
    """Run a standard test with a car.

    `settings`: other than the defaults; `progress`: called with the fraction done, 0 to 1. Raises `HostError` if a
    setting is wrong, or the test cannot be done with the car.
    """
    test_settings = settings_of_test(test, settings or {})
    reason = reason_against(test, car, test_settings)
    if reason is not None:
        raise HostError(reason)
    progress(0.0)
    record = test.perform(car, test_settings, progress)
    progress(1.0)
    return replace(record, notes=[*record.notes, *_message_notes(record)])


def _message_notes(record: TestRecord) -> list[str]:
    """Notes on messages of the FMU with the names of the runs."""
    runs: dict[str, list[str]] = {}
    for name, result in record.runs.items():
        for message in dict.fromkeys(" ".join(m.split()) for m in result.messages):
            runs.setdefault(message, []).append(name)
    messages = []
    for message, names in list(runs.items())[:_MAX_MESSAGES]:
        where = "every run" if len(names) == len(record.runs) > 1 else some_of(names, _MAX_NAMES)
        text = message if len(message) <= _MAX_MESSAGE_LENGTH else f"{message[:_MAX_MESSAGE_LENGTH]}..."
        messages.append(f"The FMU reported in {where}: {text}")
    if len(runs) > _MAX_MESSAGES:
        messages.append(f"The FMU reported {len(runs) - _MAX_MESSAGES} other messages.")
    return messages
