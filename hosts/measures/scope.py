"""Evaluates the expressions of the files of tests, by simpleeval."""

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

# Those of simpleeval check the lengths of operands, which arrays have, too.
_OPERATORS = simpleeval.DEFAULT_OPERATORS | {ast.Add: operator.add, ast.Mult: operator.mul, ast.Pow: operator.pow}


class Scope:
    """Names with values for expressions; formulas are evaluated when an expression first reads them.

    `names`: values by name; `formulas`: expressions by name; `functions`: in addition to those of `LIBRARY`.
    """

    def __init__(
        self, names: Mapping[str, Any], formulas: Mapping[str, str], functions: Mapping[str, Callable[..., Any]]
    ) -> None:
        self._names, self._formulas, self._functions = dict(names), formulas, functions
        self._values: dict[str, Any] = {"nan": math.nan, **names}

    def __getitem__(self, name: str) -> Any:
        if name not in self._values:
            formula = self._formulas[name]
            try:
                self._values[name] = self.evaluate(formula)
            except HostError as error:  # is raised at each access
                self._values[name] = error
        if isinstance(result := self._values[name], HostError):
            raise result
        return result

    def inner(self, names: Mapping[str, Any]) -> Scope:
        """A scope with further names, in which formulas are evaluated again."""
        return Scope(self._names | dict(names), self._formulas, self._functions)

    def evaluate(self, expression: str) -> Any:
        """The value of an expression. Raises `HostError` if a signal that it reads is missing."""
        functions = {**LIBRARY, **self._functions}
        evaluator = simpleeval.EvalWithCompoundTypes(dict(_OPERATORS), functions, self)
        return evaluator.eval(expression, _parse(expression))

    def formatted(self, template: str) -> str:
        """A text with the values of its ``{expression:format}``, as of an f-string of Python."""
        return str(self.evaluate(f"f'''{template}'''")) if "{" in template else template


@lru_cache(maxsize=2000)
def _parse(expression: str) -> ast.expr:
    return ast.parse(expression.strip(), mode="eval").body
