"""The results of a running test: measures, notes and plots by the expressions of its file."""

import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict

from hosts.catalogue.car import TestedCar
from hosts.catalogue.preparation import early_end_notes, with_step_up_to
from hosts.catalogue.standard_test import Line, Plot, Setting, TestRecord
from hosts.catalogue.steering import SteeringInput
from hosts.common.display_units import shown_in
from hosts.common.errors import HostError
from hosts.common.numbers import is_round_off
from hosts.driving.result import Result
from hosts.measures.measure import Limit, Measure
from hosts.measures.scope import Scope

_FUNCTIONS: Mapping[str, Callable[..., Any]] = {"steering_input": lambda car: SteeringInput.of(car.facts)}
_NAMES = {"is_angle": "steering_input(car).is_angle"}
"""Expressions by name for all files: whether angles of the steering wheel are known."""
_TOLERANCE = 0.05
NOT_SHOWN = "The runs do not show it."


class _Typed(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Sentence(_Typed):
    """A text with ``{expressions}`` that is reported if the expression `when` is true."""

    when: str
    text: str


class _NoteLine(Sentence):
    """`when` may have ``{expressions}`` too."""

    each: dict[str, tuple[Any, ...]] | str = "[{}]"
    """See `_MeasureLine.each`."""


class _LimitLine(_Typed):
    source: str
    lowest: float | str = -math.inf
    highest: float | str = math.inf
    when: str = "True"


class _MeasureLine(_Typed):
    value: str
    """An expression."""
    unit: str
    text: str
    unit_of_input: str = ""
    """Unit if angles of the steering wheel are unknown."""
    sides: Literal["", "mean", "difference"] = ""
    """Whether the measure is the mean or the relative difference of the scopes `left` and `right`."""
    each: dict[str, tuple[Any, ...]] | str = "[{}]"
    """Names with a value for each of several measures; or an expression that yields mappings of names to values."""
    note: str = ""
    missing: str = ""
    """Note if there is no number; empty: `note`."""
    exists: str = "True"
    """Expression: whether a missing number exists."""
    limit: _LimitLine | None = None


class _PlotLine(_Typed):
    title: str
    x: tuple[str, str]
    """Label of the axis, and an expression."""
    y: str
    """Label of the axis."""
    lines: dict[str, str]
    """Expressions by labels; a line without a finite point, or of a missing signal, is left out."""
    each: str = "[{}]"
    """Expression that yields mappings of names to values; each adds the lines."""
    log_x: bool = False
    log_y: bool = False
    equal: bool = False


class Part(_Typed):
    """Measures, notes and plots of one kind of run."""

    measures: dict[str, _MeasureLine] = {}
    notes: tuple[_NoteLine, ...] = ()
    plots: tuple[_PlotLine, ...] = ()


class TestTables(_Typed):
    """The tables of a test's file that are evaluated."""

    __test__ = False  # no test of pytest's

    names: dict[str, str] = {}
    """Expressions by name, for other expressions."""
    refusals: tuple[Sentence, ...] = ()
    """Reasons why the test cannot be done with settings and a car."""
    parts: dict[str, Part] = {}
    settings: tuple[Setting, ...] = ()

    def scope(self, car: TestedCar, settings: Mapping[str, float]) -> Scope:
        return Scope({**settings, "car": car}, {**_NAMES, **self.names}, _FUNCTIONS)

    def why_not(self, car: TestedCar, settings: Mapping[str, float]) -> str | None:
        """See `StandardTest.why_not`."""
        scope = self.scope(car, settings)
        return next((scope.formatted(r.text) for r in self.refusals if scope.evaluate(r.when)), None)


class Sheet:
    """The results of a test so far.

    `car`, `settings`, `progress`: see `StandardTest.perform`. `runs`, `notes`: runs and notes of the record.
    """

    def __init__(
        self, tables: TestTables, car: TestedCar, settings: Mapping[str, float], progress: Callable[[float], None]
    ) -> None:
        self.car, self.settings, self.progress = car, settings, progress
        self.runs: dict[str, Result] = {}
        self.notes: list[str] = []
        self.measures: list[Measure] = []
        self._plots: list[Plot] = []
        self._tables = tables

    def setting_text(self, setting: str) -> str:
        """The description of a setting up to its first semicolon."""
        return next(s.text for s in self._tables.settings if s.name == setting).partition(";")[0]

    def with_step_up_to(self, longest: float, quantity: str) -> TestedCar:
        """The car with a communication step up to `longest`, s; see `preparation.with_step_up_to`."""
        car, notes = with_step_up_to(self.car, longest, quantity)
        self.notes += notes
        return car

    def add_run(self, name: str, run: Result) -> Result:
        """Add a run to the record, and a note if it ended early. Returns the run."""
        self.runs[name] = run
        self.notes += early_end_notes(name.replace("_", " "), run)
        return run

    def add(self, part: str, /, **names: Any) -> None:
        """Evaluate a part of the file.

        `names`: values for its expressions, in addition to settings and `car`. `why_none` and `should_be` are the note
        and the existence of its measures without a number; mappings `left` and `right` are the scopes of measures of
        both sides. A `HostError` instead of a value is the reason why measures that read it have no number.
        """
        scope = self._scope(names)
        sides = {side: scope.inner(x) for side in ("left", "right") if isinstance(x := names.get(side), Mapping)}
        scope = scope.inner(sides)
        table = self._tables.parts[part]
        for name, line in table.measures.items():
            for extra in _expansions(scope, line.each):
                line_scope = scope.inner(extra)
                self.measures.append(_measure(line_scope.formatted(name), line, line_scope))
        for note_line in table.notes:
            results = [scope.inner(extra) for extra in _expansions(scope, note_line.each)]
            self.notes += [
                note_scope.formatted(note_line.text)
                for note_scope in results
                if _is_true(note_scope, note_scope.formatted(note_line.when))
            ]
        self._plots += [plot for line in table.plots if (plot := _plot(line, scope)).lines]

    def value(self, expression: str, **names: Any) -> Any:
        """The value of an expression of the file; see `add`."""
        return self._scope(names).evaluate(expression)

    def _scope(self, names: Mapping[str, Any]) -> Scope:
        return self._tables.scope(self.car, self.settings).inner({"why_none": "", "should_be": True, **names})

    def record(self) -> TestRecord:
        """The record of all results."""
        return TestRecord(self.measures, self._plots, self.runs, self.notes)


def _is_true(scope: Scope, expression: str) -> bool:
    try:
        return bool(scope.evaluate(expression))
    except HostError:  # a signal is missing
        return False


def _number_or_error(scope: Scope, expression: str, side: str = "") -> tuple[float, str]:
    """The number of an expression, or NaN with the reason. `side`: name of a scope within `scope`."""
    try:
        return float((scope[side] if side else scope).evaluate(expression)), ""
    except HostError as error:
        return math.nan, str(error)


def _measure(name: str, line: _MeasureLine, scope: Scope) -> Measure:
    reason, exists = scope["why_none"], scope["should_be"]
    unit = scope.formatted(line.unit if not line.unit_of_input or scope["is_angle"] else line.unit_of_input)
    text = scope.formatted(line.text)
    if line.sides:
        (left, error), (right, _) = (_number_or_error(scope, line.value, side) for side in ("left", "right"))
        if line.sides == "difference":
            return asymmetry(name, left, right, text, error or reason)
        missing = error or reason or scope.formatted(line.missing)
        return mean_of_sides(
            name, left, right, unit, text, missing, exists and (bool(error) or bool(scope.evaluate(line.exists)))
        )
    value, error = _number_or_error(scope, line.value)
    limit = None if line.limit is None else _limit(line.limit, scope)
    if math.isfinite(value):
        return Measure(name, value, unit, text, limit, scope.formatted(line.note))
    is_expected = exists and (bool(error) or bool(scope.evaluate(line.exists)))
    note = error or reason or scope.formatted(line.missing or line.note) or NOT_SHOWN
    return Measure(name, math.nan, unit, text, limit, note, is_expected)


def _limit(line: _LimitLine, scope: Scope) -> Limit | None:
    if not _is_true(scope, line.when):
        return None
    low, high = (float(scope.evaluate(x)) if isinstance(x, str) else x for x in (line.lowest, line.highest))
    return Limit(scope.formatted(line.source), low, high)


def _plot(line: _PlotLine, scope: Scope) -> Plot:
    lines: list[Line] = []
    for label, y in line.lines.items():
        with suppress(HostError):  # a signal is missing
            for names in _expansions(scope, line.each):
                line_scope = scope.inner(names)
                x, values = (np.asarray(line_scope.evaluate(text), float) for text in (line.x[1], y))
                curve = Line(line_scope.formatted(label), x, values)
                lines += [curve] if curve.y.ndim and np.isfinite(curve.y).any() else []
    return Plot(scope.formatted(line.title), line.x[0], line.y, lines, line.log_x, line.log_y, line.equal)


def _expansions(scope: Scope, each: str | Mapping[str, Sequence[Any]]) -> Sequence[Mapping[str, Any]]:
    if not isinstance(each, str):
        return [dict(zip(each, values, strict=True)) for values in zip(*each.values(), strict=True)]
    result: Sequence[Mapping[str, Any]] = scope.evaluate(each)
    return result


def mean_of_sides(
    name: str, left: float, right: float, unit: str, text: str, reason: str = "", exists: bool = True
) -> Measure:
    """Mean of left and right, with a note if they differ by more than 5 %, or one is missing.

    `left`, `right`: NaN if a run does not yield it; `reason`: note if both are missing; `exists`: whether the number
    exists if both are missing.
    """
    finite = [x for x in (left, right) if math.isfinite(x)]
    if not finite:
        return Measure(name, math.nan, unit, text, None, reason or NOT_SHOWN, exists)
    mean = sum(finite) / len(finite)
    note = ""
    if len(finite) == 1:
        note = f"Of the turn to the {'left' if math.isfinite(left) else 'right'} alone: the other does not show it."
    elif abs(left - right) > _TOLERANCE * abs(mean):
        unit_text, factor = shown_in(unit, name)
        note = f"Left {factor * left:.4g}, right {factor * right:.4g}{'' if unit_text == '1' else f' {unit_text}'}."
    return Measure(name, mean, unit, text, None, note)


def asymmetry(name: str, left: float, right: float, text: str, reason: str = "") -> Measure:
    """Absolute difference of left and right over their mean. `reason`: note if one is missing."""
    value = math.nan
    if math.isfinite(left + right) and left + right != 0.0:
        value = 0.0 if is_round_off(left - right, left) else abs(left - right) / (0.5 * abs(left + right))
    note = "" if math.isfinite(value) else reason or "There are no runs to both sides."
    return Measure(name, value, "1", text, None, note)
