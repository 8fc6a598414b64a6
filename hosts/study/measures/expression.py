"""Expressions such as ``max(abs(chassis.ay), after=2.0)``, evaluated by simpleeval.

Users write them: names, forms and units are checked before the first run. Those of standard tests
(`hosts.measures.scope`) have no units.
"""

from __future__ import annotations

import ast
import hashlib
import math
import operator
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import simpleeval

from ali3.message_text import sentence_of
from ali3.near_names import MOST, did_you_mean
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.driving.result import Result
from hosts.measures.measure import Measure
from hosts.study.measures.quantity import ANY, NONE, Quantity
from hosts.study.measures.reductions import REDUCTIONS, NotYieldedError

TIME = "time"
_FUNCTIONS: Mapping[str, Callable[..., Quantity]] = {"abs": operator.abs, **REDUCTIONS}
_OPERATORS: Mapping[type[ast.AST], Callable[..., Quantity]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
}


@dataclass(frozen=True)
class Expression:
    """A measure of a run by reductions of its signals; made by `read`."""

    name: str
    text: str

    @staticmethod
    def read(text: str, name: str = "") -> Expression:
        """Read an expression, and check its form; `columns` checks its signals.

        Raises `HostError` with the part that cannot be read.
        """
        tree, signals = _parse(text)
        samples = np.zeros(1)
        try:
            result = _evaluate(text, {name: Quantity(name, samples, ANY, samples) for name in signals})
        except NotYieldedError:  # of the one sample; the form is right
            result = None
        if result is not None and result.time is not None:
            raise HostError(
                f"The measure '{text}' is a signal over time, not a number; reduce it, such as by max({result.text}), "
                f"rms({result.text}) or final({result.text})."
            )
        if not signals:
            raise HostError(f"The measure '{text}' reads no signal; it is the same for every run.")
        return Expression(name or ast.unparse(tree), text.strip())

    @property
    def signals(self) -> frozenset[str]:
        """Names of the signals that the expression reads."""
        return _parse(self.text)[1] - {TIME}

    @property
    def digest(self) -> str:
        """Hash of the text."""
        return hashlib.sha256(ast.unparse(_parse(self.text)[0]).encode()).hexdigest()

    def columns(self, units: Mapping[str, str], stop_time: float | None = None) -> dict[str, str]:
        """The column with its unit; see `hosts.study.measures.study_measure.StudyMeasure`."""
        for signal in sorted(self.signals):
            if signal not in units:
                raise HostError(
                    f"The measure '{self.text}' needs '{signal}', which is not an input or "
                    f"output{similar_names(signal, units)}"
                )
        time = np.array([0.0, np.finfo(float).max if stop_time is None else stop_time])
        signals = {n: Quantity(n, np.ones(2), units.get(n, "s") or NONE, time) for n in (*self.signals, TIME)}
        try:
            return {self.name: _evaluate(self.text, signals).unit}
        except NotYieldedError as error:
            raise HostError(f"The measure '{self.text}' cannot be computed for any run. {error}") from None

    def evaluate(self, result: Result, parameters: Mapping[str, Value] | None = None) -> list[Measure]:
        """Evaluate the expression; see `StudyMeasure`."""
        value, note, unit = math.nan, "", ""
        try:
            if result.refusal:
                raise NotYieldedError(sentence_of(result.refusal))
            quantity = _evaluate(self.text, self._signals_of(result))
            value, unit = float(quantity.values), quantity.unit
            if not math.isfinite(value):
                note = f"'{self.text}' is {value:g}: it divides by zero or is too large for a number."
                value = math.nan
        except (NotYieldedError, HostError) as error:
            note = str(error)
        return [Measure(self.name, value, unit, self.text, note=note)]

    def _signals_of(self, result: Result) -> dict[str, Quantity]:
        results = {TIME: Quantity(TIME, result.time, "s", result.time)}
        for signal in sorted(self.signals):
            if signal not in result:
                raise HostError(f"The run has no signal '{signal}'.")
            values = np.asarray(result.continuous(signal), dtype=float)
            is_wrong = ~np.isfinite(values)
            if is_wrong.any():
                first = int(is_wrong.argmax())
                raise NotYieldedError(f"'{signal}' is {values[first]:g} at {result.time[first]:g} s.")
            results[signal] = Quantity(signal, values, result.units.get(signal) or NONE, result.time)
        return results


def _evaluate(text: str, signals: Mapping[str, Quantity]) -> Quantity:
    """The value of an expression.

    Raises `HostError` if a part of it is not allowed, `NotYieldedError` if the signals do not yield a value.
    """
    label = f"The measure '{text}'"
    evaluator = simpleeval.SimpleEval(operators=dict(_OPERATORS), functions=dict(_FUNCTIONS))
    node_types = (ast.UnaryOp, ast.BinOp, ast.Call, ast.keyword)
    evaluator.nodes = {node: evaluator.nodes[node] for node in node_types}
    evaluator.nodes |= dict.fromkeys((ast.Name, ast.Attribute, ast.Subscript), lambda node: signals[_signal_name(node)])
    evaluator.nodes[ast.Constant] = lambda node: signals[node.value] if node.value in signals else _number(node)
    try:
        with np.errstate(all="ignore"):
            result = evaluator.eval(text, _parse(text)[0])
    except HostError as error:
        raise HostError(f"{label}: {error}") from None
    except simpleeval.FunctionNotDefined as error:
        allowed = ", ".join(_FUNCTIONS)
        raise HostError(f"{label} has no function '{error.func_name}' to use; there are: {allowed}.") from None
    except (simpleeval.InvalidExpression, TypeError, KeyError):
        allowed = f"signals, numbers, + - * / and the functions {', '.join(_FUNCTIONS)}"
        raise HostError(f"{label} cannot be read: {allowed} can stand there.") from None
    except RecursionError:
        raise HostError(f"{label} is nested too deep; use a function in a file: file.py:function.") from None
    assert isinstance(result, Quantity)
    return result


def _number(node: ast.Constant) -> Quantity:
    if isinstance(node.value, bool) or not isinstance(node.value, (int, float)):
        raise HostError(f"'{ast.unparse(node)}' is not a number.")
    try:
        value = float(node.value)
    except OverflowError:
        value = math.inf
    if not math.isfinite(value):
        raise HostError("it has a number that is too large.")
    return Quantity(ast.unparse(node), np.asarray(value))


@lru_cache(maxsize=1000)
def _parse(text: str) -> tuple[ast.expr, frozenset[str]]:
    """The tree of an expression, and the names of its signals."""
    try:
        tree = ast.parse(text.strip(), mode="eval").body
        return tree, frozenset(_signal_names(tree))
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        message = (error.msg if isinstance(error, SyntaxError) else "") or "it is not an expression"
        raise HostError(
            f"The measure '{text}' cannot be read: {message}. Forms: max(abs(chassis.ay), after=2.0), "
            "value(speed, 3.0), range('a name with signs'), file.py:function."
        ) from None


def _signal_names(node: ast.AST) -> Iterator[str]:
    """Names of signals in an expression: with dots and indices, or as a text in quotation marks."""
    root = node
    while isinstance(root, (ast.Attribute, ast.Subscript)):
        root = root.value
    if isinstance(root, ast.Name) or (isinstance(node, ast.Constant) and isinstance(node.value, str)):
        yield _signal_name(node)
    else:
        children = [*node.args, *node.keywords] if isinstance(node, ast.Call) else ast.iter_child_nodes(node)
        for child in children:
            yield from _signal_names(child)


def _signal_name(node: ast.AST) -> str:
    return str(node.value) if isinstance(node, ast.Constant) else ast.unparse(node).replace(" ", "")


def similar_names(name: str, known: Mapping[str, str]) -> str:
    """The end of a message on an unknown name: similar names, or the known ones."""
    return did_you_mean(name, known, f"there are: {', '.join(known) or 'none'}" if len(known) <= 2 * MOST else "")
