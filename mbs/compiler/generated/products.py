"""C code of products by coordinates (J' w, M x, forces of elements on their signals) and of the signals."""

from collections.abc import Sequence

from mbs.compiler.generated.pattern import Pattern
from mbs.compiler.generated.text import are_consecutive, function, literal, vector

TRANSPOSED = "APART void rows_transposed(const double *restrict J, const double *restrict w, double *restrict out)"
MASS = "APART void mass_times(const double *restrict val, const double *restrict x, double *restrict out)"
SIGNALS = (
    "APART void signals{0}(const double *restrict val, const double *restrict constant, const double *restrict q, "
    "const double *restrict qd, double *restrict u, double *restrict ud)"
)
FORCES = (
    "APART void forces{0}(const double *restrict val, const unsigned char *restrict idle, const double *restrict f, "
    "double *restrict Q)"
)


def store(array: str, first: int, length: int, value: str, end: int) -> list[str]:
    """C that stores `length` numbers of a vector in an array with `end` entries, beginning at `first`.

    The entry after them may be overwritten: it is written later.
    """
    if length == 1:
        return [f"  {array}[{first}] = {value};"]
    if length == 2:
        return [f"  {{ const four a = {value}; {array}[{first}] = a[0]; {array}[{first + 1}] = a[1]; }}"]
    return [f"  {'PUT' if first + 4 <= end else 'put3'}({array} + {first}, {value});"]


def transpose_product(pattern: Pattern) -> list[str]:
    """C function of J' w, each sum in the order of the rows."""
    entries: list[list[tuple[int, int]]] = [[] for _ in range(pattern.nq)]
    for k in range(pattern.nc):
        for i in range(pattern.row_ptr[k], pattern.row_ptr[k + 1]):
            entries[pattern.row_col[i]].append((i, k))
    lines: list[str] = []
    c = 0
    while c < pattern.nq:
        length = 1
        while (
            length < 4 and c + length < pattern.nq and entries[c + length] == [(i + length, k) for i, k in entries[c]]
        ):
            length += 1
        if not entries[c]:
            lines.append(f"  out[{c}] = 0.0;")
            c += 1
            continue
        if length == 2:
            length = 1
        text = "NONE" if length > 1 else "0.0"
        for i, k in entries[c]:
            text = f"({text} + {vector('J', range(i, i + length))} * w[{k}])"
        lines += store("out", c, length, text, pattern.nq)
        c += length
    return function(TRANSPOSED, lines)


def mass(pattern: Pattern) -> list[str]:
    """M x of the constant mass matrix."""
    ptr, col = pattern.array["mass_ptr"], pattern.array["mass_col"]
    lines: list[str] = []
    i = 0
    while i < pattern.nq:
        length = 3 if i in pattern.mass_triples else 1
        text = "NONE" if length > 1 else "0.0"
        for k in range(ptr[i], ptr[i + 1]):
            text = f"({text} + {vector('x', range(col[k], col[k] + length))} * val[{k}])"
        lines += store("out", i, length, text, pattern.nq)
        i += length
    return function(MASS, lines)


def signals(pattern: Pattern) -> list[str]:
    """Signals that elements use, and their rates."""
    lines: list[str] = []
    n = 0
    while n < len(pattern.active):
        i, triple = pattern.active[n], pattern.active_triple[n]
        length = 3 if triple else 1
        follows = n + 3 < len(pattern.active) and pattern.active[n + 3] == i + 3
        value = literal([f"constant[{i + d}]" for d in range(3)]) if triple else f"constant[{i}]"
        rate = "NONE" if triple else "0.0"
        for k in pattern.entries(i):
            columns = range(pattern.sig_col[k], pattern.sig_col[k] + length)
            value = f"({value} + val[{k}] * {vector('q', columns)})"
            rate = f"({rate} + val[{k}] * {vector('qd', columns)})"
        for name, text in (("u", value), ("ud", rate)):
            if triple:
                lines.append(f"  {'PUT' if follows else 'put3'}({name} + {i}, {text});")
            else:
                lines.append(f"  {name}[{i}] = {text};")
        n += length
    return function(SIGNALS.format(pattern.suffix), lines)


def forces(pattern: Pattern) -> list[str]:
    """Adds the forces on signals to Q, element by element; idle elements have zero forces."""
    ptr = pattern.array["el_sig_ptr"]
    terms: list[list[tuple[int, int, int]]] = [[] for _ in range(1 + max([pattern.nq - 1, *pattern.sig_col]))]
    for element in pattern.elements:
        for i, signal in enumerate(element.signals):
            for k in pattern.entries(signal):
                terms[pattern.sig_col[k]].append((element.number, i, k))
    lines = [
        f"  const double *f{e.number} = idle[{e.number}] ? nothing : f + {ptr[e.number]};"
        for e in pattern.elements
        if any(len(pattern.entries(s)) for s in e.signals)
    ]
    groups = [*pattern.groups, *(range(c, c + 1) for c in range(pattern.nq, len(terms)))]
    for group in groups:
        lists = [terms[c] for c in group]
        if not any(lists):
            continue
        text = literal([f"Q[{c}]" for c in group]) if len(group) == 3 else f"Q[{group[0]}]"
        for m in range(max(map(len, lists))):
            text = f"({text} + {_force(pattern, [x[m] if m < len(x) else None for x in lists])})"
        lines.append(f"  put3(Q + {group[0]}, {text});" if len(group) == 3 else f"  Q[{group[0]}] = {text};")
    return function(FORCES.format(pattern.suffix), lines)


def _force(pattern: Pattern, terms: Sequence[tuple[int, int, int] | None]) -> str:
    """Values times forces at one coordinate or three."""
    present = [t for t in terms if t is not None]
    if len(terms) == 1:
        e, i, k = present[0]
        return f"val[{k}] * f{e}[{i}]"
    if len(present) == 3:
        e, i, k = present[0]
        same_element = all(t[0] == e for t in present)
        in_array = pattern.array["el_sig_ptr"][e] + i + 4 <= len(pattern.array["el_sig"])
        if (
            same_element
            and in_array
            and are_consecutive([t[1] for t in present])
            and _is_triple_term(pattern, e, i, present)
        ):
            return f"val[{k}] * V(f{e} + {i})"
        if (
            same_element
            and all(t[1] == i for t in present)
            and are_consecutive([t[2] for t in present])
            and k + 4 <= len(pattern.sig_val)
        ):
            return f"V(val + {k}) * f{e}[{i}]"
    return literal(["0.0" if t is None else f"val[{t[2]}] * f{t[0]}[{t[1]}]" for t in terms])


def _is_triple_term(pattern: Pattern, e: int, i: int, terms: Sequence[tuple[int, int, int]]) -> bool:
    """Whether three terms belong to one triple of signals and to the same entry of each signal."""
    first = pattern.elements[e]
    if not first.triple[i]:
        return False
    offsets = [k - pattern.entries(first.signals[t])[0] for _, t, k in terms]
    return len(set(offsets)) == 1
