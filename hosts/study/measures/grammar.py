"""Which forms an expression may have; anything else is refused before it is evaluated."""

from __future__ import annotations

import ast
import math
from typing import TypeAlias

from hosts.common.errors import HostError
from hosts.study.measures.reductions import REDUCTIONS

Node: TypeAlias = ast.expr

_OPERATIONS = (ast.Add, ast.Sub, ast.Mult, ast.Div)
_DEEPEST = 30


def signal_name(node: ast.AST) -> str | None:
    """The name that a node is: with dots and indices, or a text in quotation marks; None: it is no name."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, (ast.Attribute, ast.Subscript)):
        inner: ast.expr = node
        while isinstance(inner, (ast.Attribute, ast.Subscript)):
            inner = inner.value
        return ast.unparse(node).replace(" ", "") if isinstance(inner, ast.Name) else None
    return None


def number_of(node: ast.AST) -> float:
    """The number a node is, maybe with a sign; NaN where it is not a number."""
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.USub, ast.UAdd)):
        inner = number_of(node.operand)
        return -inner if isinstance(node.op, ast.USub) else inner
    if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)) and not isinstance(node.value, bool):
        return float(node.value)
    return math.nan


def windows(node: ast.AST) -> list[tuple[str, float]]:
    """Times in s that stand in an expression, each with ``after``, ``before`` or ``value``."""
    found = []
    for part in ast.walk(node):
        if isinstance(part, ast.Call) and isinstance(part.func, ast.Name):
            found += [(str(k.arg), number_of(k.value)) for k in part.keywords]
            if part.func.id == "value":
                found.append(("value", number_of(part.args[1])))
    return found


def check_form(node: Node, text: str) -> None:
    """Refuse what is no number of a run.

    Raises `HostError` with the part that cannot be read, and what would be right.
    """
    if _is_series(node, text, 0):
        example = ast.unparse(node)
        raise HostError(
            f"The measure '{text}' is a signal over time, not a number; reduce it, such as by max({example}), "
            f"rms({example}) or final({example})."
        )
    if not any(isinstance(part, ast.Call) and part.func for part in ast.walk(node)):
        raise HostError(f"The measure '{text}' reads no signal; it is the same for every run.")


def _is_series(node: ast.AST, text: str, depth: int) -> bool:
    """Whether it is a signal over time; else it is a number."""
    where = f"The measure '{text}'"
    if depth > _DEEPEST:
        raise HostError(f"{where} is nested more than {_DEEPEST} deep; use a function in a file: file.py:function.")
    if signal_name(node) is not None:
        return True
    if not math.isnan(number_of(node)):
        if math.isinf(number_of(node)):
            raise HostError(f"{where} has a number that is too large.")
        return False
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.USub, ast.UAdd)):
        return _is_series(node.operand, text, depth + 1)
    if isinstance(node, ast.BinOp) and isinstance(node.op, _OPERATIONS):
        return _is_series(node.left, text, depth + 1) | _is_series(node.right, text, depth + 1)
    if isinstance(node, ast.Call):
        return _is_series_call(node, text, depth)
    raise HostError(
        f"{where} cannot be read at '{ast.unparse(node)}': signals, numbers, + - * / and the functions "
        f"{', '.join(('abs', *REDUCTIONS))} can stand there."
    )


def _is_series_call(node: ast.Call, text: str, depth: int) -> bool:
    where = f"The measure '{text}'"
    name = node.func.id if isinstance(node.func, ast.Name) else ast.unparse(node.func)
    if name != "abs" and name not in REDUCTIONS:
        raise HostError(f"{where} has no function '{name}' to use; there are: {', '.join(('abs', *REDUCTIONS))}.")
    second = "" if name == "abs" else REDUCTIONS[name].number
    wanted = 2 if second else 1
    if len(node.args) != wanted:
        needs = f"a signal and {second}" if second else "one signal"
        raise HostError(f"{where}: {name} takes {needs}; it was given {len(node.args)} arguments.")
    series = _is_series(node.args[0], text, depth + 1)
    if name != "abs" and not series:
        raise HostError(f"{where}: {name} takes a signal over time; '{ast.unparse(node.args[0])}' is a number.")
    if second:
        number = number_of(node.args[1])
        if not math.isfinite(number) or number < 0.0 or (name == "percentile" and number > 100.0):
            raise HostError(f"{where}: the second argument of {name} is {ast.unparse(node.args[1])}, not {second}.")
    _check_window(node, name, where)
    return name == "abs" and series


def _check_window(node: ast.Call, name: str, where: str) -> None:
    if node.keywords and (name == "abs" or not REDUCTIONS[name].windowed):
        raise HostError(f"{where}: {name} has no {node.keywords[0].arg}.")
    limits = {}
    for keyword in node.keywords:
        if keyword.arg not in ("after", "before"):
            raise HostError(f"{where}: {name} has no {keyword.arg}; it has after and before, times in s.")
        limits[keyword.arg] = number_of(keyword.value)
        if not math.isfinite(limits[keyword.arg]) or limits[keyword.arg] < 0.0:
            raise HostError(f"{where}: {keyword.arg} is {ast.unparse(keyword.value)}, not a time of the run in s.")
    if "after" in limits and "before" in limits and limits["after"] >= limits["before"]:
        raise HostError(
            f"{where}: it is to begin after {limits['after']:g} s and to end before {limits['before']:g} s."
        )
