"""The result of a test while it runs: measures, notes and plots that its file describes."""

import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict

from hosts.catalogue.car import TestedCar
from hosts.catalogue.preparation import early_end, with_step_up_to
from hosts.catalogue.record import Line, Plot, Setting, TestRecord
from hosts.catalogue.side_measures import NOT_SHOWN, asymmetry, mean_of_sides
from hosts.catalogue.steering import SteeringInput
from hosts.common.errors import HostError
from hosts.driving.result import Result
from hosts.measures.measure import Limit, Measure
from hosts.measures.scope import Scope

_FUNCTIONS: Mapping[str, Callable[..., Any]] = {"steering_input": lambda car: SteeringInput.of(car.facts)}
_NAMES = {"is_angle": "steering_input(car).is_angle"}
"""Expressions by names that all files have: whether angles of the steering wheel are known."""


class _Typed(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Sentence(_Typed):
    """A text with ``{expressions}`` that is said where an expression is true."""

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
    """Where angles of the steering wheel are not known."""
    sides: Literal["", "mean", "difference"] = ""
    """Whether it is taken of the scopes `left` and `right`, as their mean or by how much they differ."""
    each: dict[str, tuple[Any, ...]] | str = "[{}]"
    """Names with their values one after the other, as many measures; or an expression of mappings of names."""
    note: str = ""
    missing: str = ""
    """Said in place of `note` where there is no number."""
    exists: str = "True"
    """Whether there should be a number where there is none."""
    limit: _LimitLine | None = None


class _PlotLine(_Typed):
    title: str
    x: tuple[str, str]
    """What stands at the axis, and an expression."""
    y: str
    lines: dict[str, str]
    """Expressions by labels; a line that has no finite point, or reads a signal that is not there, is left out."""
    each: str = "[{}]"
    """Expression of mappings of names: of each come the lines."""
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
    """Expressions by the names by which others read them."""
    refusals: tuple[Sentence, ...] = ()
    """Why the test cannot be done with settings and a car."""
    parts: dict[str, Part] = {}
    settings: tuple[Setting, ...] = ()

    def scope(self, car: TestedCar, settings: Mapping[str, float]) -> Scope:
        """Names of settings, and `car`."""
        return Scope({**settings, "car": car}, {**_NAMES, **self.names}, _FUNCTIONS)

    def why_not(self, car: TestedCar, settings: Mapping[str, float]) -> str | None:
        """See `StandardTest.why_not`."""
        scope = self.scope(car, settings)
        return next((scope.formatted(r.text) for r in self.refusals if scope.evaluate(r.when)), None)


class Sheet:
    """The results of a test so far.

    `car`, `settings`, `progress`: see `StandardTest.perform`. `runs`, `notes`: of the record.
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

    def words_of(self, setting: str) -> str:
        """The description of a setting up to its first semicolon."""
        return next(s.text for s in self._tables.settings if s.name == setting).partition(";")[0]

    def with_step_up_to(self, longest: float, why: str) -> TestedCar:
        """The car with a communication step that resolves what is measured; see `preparation.with_step_up_to`."""
        car, notes = with_step_up_to(self.car, longest, why)
        self.notes += notes
        return car

    def keep(self, name: str, run: Result) -> Result:
        """A run that belongs to the record, and a note where it ended early."""
        self.runs[name] = run
        self.notes += early_end(name.replace("_", " "), run)
        return run

    def add(self, part: str, /, **names: Any) -> None:
        """Evaluate a part of the file.

        `names`: that its expressions read beside settings and `car`. Among them `why_none` and `should_be`, of all its
        measures that have no number; mappings as `left` and `right`, of measures of both sides. A `HostError` in place
        of a value says why measures that read it have none.
        """
        scope = self._scope(names)
        sides = {side: scope.inner(x) for side in ("left", "right") if isinstance(x := names.get(side), Mapping)}
        scope = scope.inner(sides)
        table = self._tables.parts[part]
        for name, line in table.measures.items():
            for extra in _mappings(scope, line.each):
                inner = scope.inner(extra)
                self.measures.append(_measure(inner.formatted(name), line, inner))
        for n in table.notes:
            results = [scope.inner(extra) for extra in _mappings(scope, n.each)]
            self.notes += [each.formatted(n.text) for each in results if _true(each, each.formatted(n.when))]
        self._plots += [plot for line in table.plots if (plot := _plot(line, scope)).lines]

    def value(self, expression: str, **names: Any) -> Any:
        """The value of an expression of the file; see `add`."""
        return self._scope(names).evaluate(expression)

    def _scope(self, names: Mapping[str, Any]) -> Scope:
        return self._tables.scope(self.car, self.settings).inner({"why_none": "", "should_be": True, **names})

    def record(self) -> TestRecord:
        """The record of all results."""
        return TestRecord(self.measures, self._plots, self.runs, self.notes)


def _true(scope: Scope, expression: str) -> bool:
    try:
        return bool(scope.evaluate(expression))
    except HostError:  # a signal is not there, of which nothing is to be said
        return False


def _number(scope: Scope, expression: str, side: str = "") -> tuple[float, str]:
    """A number, of the scope of that name within another, and why there is none."""
    try:
        return float((scope[side] if side else scope).evaluate(expression)), ""
    except HostError as error:
        return math.nan, str(error)


def _measure(name: str, line: _MeasureLine, scope: Scope) -> Measure:
    why, exists = scope["why_none"], scope["should_be"]
    unit = scope.formatted(line.unit if not line.unit_of_input or scope["is_angle"] else line.unit_of_input)
    text = scope.formatted(line.text)
    if line.sides:
        (left, lost), (right, _) = (_number(scope, line.value, side) for side in ("left", "right"))
        if line.sides == "difference":
            return asymmetry(name, left, right, text, lost or why)
        missing = lost or why or scope.formatted(line.missing)
        return mean_of_sides(
            name, left, right, unit, text, missing, exists and (bool(lost) or bool(scope.evaluate(line.exists)))
        )
    value, lost = _number(scope, line.value)
    limit = None if line.limit is None else _limit(line.limit, scope)
    if math.isfinite(value):
        return Measure(name, value, unit, text, limit, scope.formatted(line.note))
    present = exists and (bool(lost) or bool(scope.evaluate(line.exists)))
    note = lost or why or scope.formatted(line.missing or line.note) or NOT_SHOWN
    return Measure(name, math.nan, unit, text, limit, note, present)


def _limit(line: _LimitLine, scope: Scope) -> Limit | None:
    if not _true(scope, line.when):
        return None
    low, high = (float(scope.evaluate(x)) if isinstance(x, str) else x for x in (line.lowest, line.highest))
    return Limit(scope.formatted(line.source), low, high)


def _plot(line: _PlotLine, scope: Scope) -> Plot:
    lines: list[Line] = []
    for label, y in line.lines.items():
        with suppress(HostError):  # a signal is not there: nor is the line
            for names in _mappings(scope, line.each):
                inner = scope.inner(names)
                x, values = (np.asarray(inner.evaluate(text), float) for text in (line.x[1], y))
                curve = Line(inner.formatted(label), x, values)
                lines += [curve] if curve.y.ndim and np.isfinite(curve.y).any() else []
    return Plot(scope.formatted(line.title), line.x[0], line.y, lines, line.log_x, line.log_y, line.equal)


def _mappings(scope: Scope, each: str | Mapping[str, Sequence[Any]]) -> Sequence[Mapping[str, Any]]:
    if not isinstance(each, str):
        return [dict(zip(each, values, strict=True)) for values in zip(*each.values(), strict=True)]
    result: Sequence[Mapping[str, Any]] = scope.evaluate(each)
    return result
