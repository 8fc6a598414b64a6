"""Units of expressions, from those of their signals."""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping

from hosts.common.errors import HostError
from hosts.study.measures.grammar import Node, signal_name
from hosts.study.measures.reductions import REDUCTIONS

NONE = "1"
_PLAIN = re.compile(r"[^/.* ]+")


def unit_of(node: Node, units: Mapping[str, str], text: str) -> str:
    """The unit of an expression.

    `node`: of a right form; `text`: of the whole measure, for messages. Raises `HostError` if different units are
    added, or a signal has none.
    """
    name = signal_name(node)
    if name is not None:
        if name not in units:
            raise HostError(f"The run has no signal '{name}'.")
        return units[name] or NONE
    if isinstance(node, ast.Call):
        assert isinstance(node.func, ast.Name)
        reduction = REDUCTIONS.get(node.func.id)
        inner = unit_of(node.args[0], units, text)
        return reduction.unit if reduction is not None and reduction.unit else inner
    if isinstance(node, ast.UnaryOp):
        return unit_of(node.operand, units, text)
    if not isinstance(node, ast.BinOp):
        return NONE
    a, b = unit_of(node.left, units, text), unit_of(node.right, units, text)
    if isinstance(node.op, ast.Mult):
        return b if a == NONE else a if b == NONE else f"{_whole(a)}.{_whole(b)}"
    if isinstance(node.op, ast.Div):
        return a if b == NONE else NONE if a == b else f"{_whole(a)}/{_whole(b)}"
    if a != b:
        sign = "+" if isinstance(node.op, ast.Add) else "-"
        raise HostError(
            f"The measure '{text}' has '{ast.unparse(node.left)}' in {a} {sign} '{ast.unparse(node.right)}' in {b}; "
            "only equal units can be added."
        )
    return a


def _whole(unit: str) -> str:
    return unit if _PLAIN.fullmatch(unit) else f"({unit})"
