"""Generated C file: its functions, and the tables of functions that the kernel reads."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from mbs.compiler.generated import fronts, products, rows, solve, tangent
from mbs.compiler.generated.pattern import Pattern
from mbs.compiler.generated.text import END, HEAD, NO_VECTORS, VECTORS

TABLE = "ali3_generated_code"
"""Name of the table in a library of generated code."""
MAX_LINES = 10_000
"""Largest number of lines of a generated function; instead of a longer one the kernel runs its loops."""

_Function = Callable[[Pattern], list[str]]
_FRONTS: dict[str, _Function] = {"factorise": fronts.factorise, "solve": solve.solve}
_ROWS: dict[str, _Function] = {
    "rows_times": rows.times,
    "rows_transposed": products.transpose_product,
    "mass_times": products.mass,
    "rows": rows.rows,
    "gamma": rows.gamma,
}
_SIGNALS: dict[str, _Function] = {"signals": products.signals, "forces": products.forces}
_TANGENT: dict[str, _Function] = {"tangent": tangent.tangent}
_NAMES = {"gamma": "gamma_of"}


def source(arrays: Mapping[str, Any], structure: int, *, avx2: bool) -> str:
    """C source of the algebra of a System.

    Parameters
    ----------
    arrays : mapping of str to array_like
        Of the System.
    structure : int
        Hash of its structure, `LoadedSystem.structure`.
    avx2 : bool
        Use AVX2 if the code is compiled for x86-64.
    """
    pattern = Pattern(arrays)
    common = _generate(pattern, _FRONTS | ({} if len(pattern.array["flex_front"]) else _ROWS))
    functions = _generate(pattern, _signal_functions(pattern))
    lines = [line for body in (common | functions).values() for line in body]
    head = [f"  .version = ALI3_GENERATED_VERSION, .structure = 0x{structure:08x}u, .avx2 = AVX2,"]
    tail = []
    if len(pattern.array["axis_signal"]):
        turned_pattern = Pattern(arrays, turned=True)
        turned = _generate(turned_pattern, _signal_functions(turned_pattern))
        lines += [line for body in turned.values() for line in body]
        tail = _table(
            "static const ali3_generated turned",
            [*head, *_table_members(common), *_table_members(turned, turned_pattern.suffix)],
        )
        head.append("  .turned = &turned,")
    visibility = ["#ifndef ALI3_INSIDE", '__attribute__((visibility("default")))', "#endif"]
    whole = _table(f"const ali3_generated {TABLE}", [*head, *_table_members(common), *_table_members(functions)])
    tail += [*visibility, f"extern const ali3_generated {TABLE};", *whole]
    max_signals = max([0, *(len(e.signals) for e in pattern.elements)])
    nothing = f"__attribute__((unused)) static const double nothing[{max_signals * max_signals + 4}];\n"
    instructions = VECTORS if avx2 else NO_VECTORS
    return "\n".join([HEAD.replace("INSTRUCTIONS", instructions), nothing, *lines, *tail, END])


def _signal_functions(pattern: Pattern) -> dict[str, _Function]:
    """Functions of signals, and of the tangent if no body is flexible or moves by a table."""
    return (_SIGNALS if pattern.elements else {}) | (_TANGENT if pattern.is_rigid else {})


def _generate(pattern: Pattern, functions: Mapping[str, _Function]) -> dict[str, list[str]]:
    bodies = {name: generate(pattern) for name, generate in functions.items()}
    return {name: lines for name, lines in bodies.items() if len(lines) <= MAX_LINES}


def _table_members(functions: Mapping[str, Sequence[str]], suffix: str = "") -> list[str]:
    return [f"  .{name} = {_NAMES.get(name, name)}{suffix}," for name in functions]


def _table(name: str, members: Sequence[str]) -> list[str]:
    return [f"{name} = {{", *members, "};"]
