"""Names by which the expressions of a file are evaluated, by simpleeval."""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

import simpleeval

from hosts.common.errors import HostError
from hosts.measures.library import LIBRARY

# those of simpleeval look at the lengths of what they add and multiply, which arrays have too
_OPERATORS = simpleeval.DEFAULT_OPERATORS | {
    ast.Add: operator.add,
    ast.Mult: operator.mul,
    ast.Pow: operator.pow,
}


class Scope:
    """Names with their values; those of `formulas` are evaluated when an expression first reads them.

    `names`: values; `formulas`: expressions by name; `functions`: beside those of `LIBRARY`.
    """

    def __init__(
        self, names: Mapping[str, Any], formulas: Mapping[str, str], functions: Mapping[str, Callable[..., Any]]
    ) -> None:
        self._names, self._formulas, self._functions = dict(names), formulas, functions
        self._found: dict[str, Any] = {"nan": math.nan, **names}

    def __getitem__(self, name: str) -> Any:
        if name not in self._found:
            formula = self._formulas[name]
            try:
                self._found[name] = self.evaluate(formula)
            except HostError as error:  # whoever reads it gets the same answer
                self._found[name] = error
        if isinstance(result := self._found[name], HostError):
            raise result
        return result

    def inner(self, names: Mapping[str, Any]) -> Scope:
        """A scope with more names, in which formulas are evaluated again."""
        return Scope(self._names | dict(names), self._formulas, self._functions)

    def evaluate(self, expression: str) -> Any:
        """The value of an expression. Raises `HostError` where a signal that it reads is not there."""
        functions = {**LIBRARY, **self._functions}
        evaluator = simpleeval.EvalWithCompoundTypes(dict(_OPERATORS), functions, self)
        return evaluator.eval(expression, _parsed(expression))

    def words(self, template: str) -> str:
        """A text in which ``{expression:format}`` stands for values, as in an f-string of Python."""
        return str(self.evaluate(f"f'''{template}'''")) if "{" in template else template


@lru_cache(maxsize=2000)
def _parsed(expression: str) -> ast.expr:
    return ast.parse(expression.strip(), mode="eval").body
