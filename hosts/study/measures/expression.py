"""Expressions such as ``max(abs(chassis.ay), after=2.0)``."""

from __future__ import annotations

import ast
import hashlib
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ali3.near_names import MOST, did_you_mean
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.driving.result import Result
from hosts.measures.measure import Measure
from hosts.study.measures.grammar import Node, check_form, number_of, signal_name, windows
from hosts.study.measures.reductions import REDUCTIONS, Array
from hosts.study.measures.units import unit_of

TIME = "time"
# Times of a run add up with rounding errors.
_SAME_TIME = 1e-9


class _NotYieldedError(Exception):
    """Why a run does not yield a measure, as a sentence."""


@dataclass(frozen=True)
class Expression:
    """A number of a run by reductions of its signals; make it by `read`."""

    name: str
    text: str

    @staticmethod
    def read(text: str, name: str = "") -> Expression:
        """An expression of which the form is right; whether its signals are there, `columns` checks.

        Raises `HostError` with what cannot be read.
        """
        tree = _parse(text)
        check_form(tree, text)
        return Expression(name or ast.unparse(tree), text.strip())

    @property
    def signals(self) -> frozenset[str]:
        """What it reads of a run."""
        return frozenset(_signals(_parse(self.text))) - {TIME}

    @property
    def digest(self) -> str:
        """Hash of the text."""
        return hashlib.sha256(ast.unparse(_parse(self.text)).encode()).hexdigest()

    def columns(self, units: Mapping[str, str], stop_time: float | None = None) -> dict[str, str]:
        """Its one column; see `StudyMeasure.columns`."""
        for signal in sorted(self.signals):
            if signal not in units:
                raise HostError(
                    f"The measure '{self.text}' needs '{signal}', which is no input or output{near(signal, units)}"
                )
        tree = _parse(self.text)
        begins = [time for what, time in windows(tree) if what != "before"]
        if stop_time is not None and begins and max(begins) > stop_time + _SAME_TIME:
            raise HostError(f"The measure '{self.text}' needs {max(begins):g} s; the runs end at {stop_time:g} s.")
        return {self.name: unit_of(tree, {**units, TIME: "s"}, self.text)}

    def evaluate(self, result: Result, parameters: Mapping[str, Value] | None = None) -> list[Measure]:
        """Its value; see `StudyMeasure.evaluate`."""
        value, note, unit = math.nan, "", ""
        try:
            unit = unit_of(_parse(self.text), {**result.units, TIME: "s"}, self.text)
            value = self._value(result)
        except (_NotYieldedError, HostError) as error:
            note = str(error)
        return [Measure(self.name, value, unit, self.text, note=note)]

    def _value(self, result: Result) -> float:
        if result.failed_steps:
            raise _NotYieldedError(f"The FMU refused the step at {result.time[-1]:g} s.")
        for signal in sorted(self.signals):
            wrong = ~np.isfinite(result[signal])
            if wrong.any():
                first = int(wrong.argmax())
                raise _NotYieldedError(f"'{signal}' is {result[signal][first]:g} at {result.time[first]:g} s.")
        with np.errstate(all="ignore"):
            value = float(_evaluate(_parse(self.text), result))
        if not math.isfinite(value):
            raise _NotYieldedError(f"'{self.text}' is {value:g}: it divides by zero or is too large for a number.")
        return value


@lru_cache(maxsize=1000)
def _parse(text: str) -> Node:
    try:
        return ast.parse(text.strip(), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        words = (error.msg if isinstance(error, SyntaxError) else "") or "it is no expression"
        raise HostError(
            f"The measure '{text}' cannot be read: {words}. Forms: max(abs(chassis.ay), after=2.0), "
            "value(speed, 3.0), range('a name with signs'), file.py:function."
        ) from None


def _signals(node: ast.AST) -> set[str]:
    name = signal_name(node)
    if name is not None:
        return {name}
    children = node.args if isinstance(node, ast.Call) else list(ast.iter_child_nodes(node))
    return set().union(*(_signals(child) for child in children))


def _evaluate(node: Node, result: Result) -> Array | float:
    """An array over time of a signal, a number of anything else."""
    name = signal_name(node)
    if name is not None:
        return np.asarray(result.time if name == TIME and TIME not in result else result.continuous(name))
    if isinstance(node, ast.Call):
        return _called(node, result)
    if isinstance(node, ast.UnaryOp):
        x = _evaluate(node.operand, result)
        return np.asarray(-x) if isinstance(node.op, ast.USub) else x
    if isinstance(node, ast.BinOp):
        a, b = np.asarray(_evaluate(node.left, result)), np.asarray(_evaluate(node.right, result))
        if isinstance(node.op, (ast.Add, ast.Sub)):
            return np.asarray(a + b if isinstance(node.op, ast.Add) else a - b)
        return np.asarray(a * b if isinstance(node.op, ast.Mult) else a / b)
    return number_of(node)


def _called(node: ast.Call, result: Result) -> Array | float:
    assert isinstance(node.func, ast.Name)
    x, name, time = np.asarray(_evaluate(node.args[0], result), dtype=float), node.func.id, result.time
    if name == "abs":
        return np.asarray(np.abs(x))
    number = number_of(node.args[1]) if len(node.args) > 1 else math.nan
    if name == "value" and not time[0] - _SAME_TIME <= number <= time[-1] + _SAME_TIME:
        raise _NotYieldedError(f"The run ends at {time[-1]:g} s, before the {number:g} s of '{ast.unparse(node)}'.")
    limits = {str(k.arg): number_of(k.value) for k in node.keywords}
    wanted = (time >= limits.get("after", -math.inf) - _SAME_TIME) & (
        time <= limits.get("before", math.inf) + _SAME_TIME
    )
    if not wanted.any():
        raise _NotYieldedError(f"The run from {time[0]:g} to {time[-1]:g} s has no sample for '{ast.unparse(node)}'.")
    x = np.broadcast_to(x, time.shape)
    return REDUCTIONS[name].apply(time[wanted], x[wanted], number)


def near(name: str, known: Mapping[str, str]) -> str:
    """What may have been meant, as the rest of a sentence."""
    return did_you_mean(name, known, f"there are: {', '.join(known) or 'none'}" if len(known) <= 2 * MOST else "")
