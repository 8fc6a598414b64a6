"""C code of Phi, Phi_q and gamma of the quadratic terms of the rows, and of J x, four rows at a time."""

from collections.abc import Iterator, Sequence

from mbs.compiler.generated.pattern import Pattern
from mbs.compiler.generated.text import are_consecutive, function, literal, vector

ROWS = (
    "APART void rows(const double *restrict lin, const double *restrict constant, const double *restrict hess, "
    "const double *restrict q, double *restrict Phi, double *restrict J)"
)
GAMMA = "APART void gamma_of(const double *restrict hess, const double *restrict q, double *restrict gamma)"
TIMES = "APART void rows_times(const double *restrict J, const double *restrict x, double *restrict out)"


def rows(pattern: Pattern) -> list[str]:
    """C function of `Phi[k] = constant[k] + 0.5 sum (e + lin) q` with entries e of Phi_q."""
    return function(ROWS, ["  (void)lin;", *_groups_of_four(pattern, False)])


def gamma(pattern: Pattern) -> list[str]:
    """C function of `gamma[k] = 0.5 sum e q` with entries e of Phi_q without linear parts, and rates instead of q."""
    return function(GAMMA, _groups_of_four(pattern, True))


def times(pattern: Pattern) -> list[str]:
    """C function of J x."""
    lines: list[str] = []
    for first in range(0, pattern.nc, 4):
        group = range(first, min(first + 4, pattern.nc))
        products = [
            [(len(run), _product(run, [pattern.row_col[i] for i in run])) for run in _runs(pattern, k, 4)]
            for k in group
        ]
        lines += _row_sums(group, products, "out", None)
    return function(TIMES, lines)


def _runs(pattern: Pattern, row: int, max_length: int) -> Iterator[Sequence[int]]:
    """Runs of entries of a row with neighbouring coordinates."""
    i, end, col = pattern.row_ptr[row], pattern.row_ptr[row + 1], pattern.row_col
    while i < end:
        length = 1
        while length < max_length and i + length < end and col[i + length] == col[i] + length:
            length += 1
        yield range(i, i + length)
        i += length


def _product(entries: Sequence[int], columns: Sequence[int]) -> str:
    """Products J x of a run of entries as a vector of four, zero after them."""
    i, c = entries[0], columns[0]
    if len(entries) == 1:
        return literal([f"J[{i}] * x[{c}]"])
    if len(entries) == 2:
        return f"WIDE(P(J + {i}) * P(x + {c}))"
    return f"V(J + {i}) * V(x + {c})"


def _groups_of_four(pattern: Pattern, of_rates: bool) -> list[str]:
    lines: list[str] = []
    for first in range(0, pattern.nc, 4):
        group = range(first, min(first + 4, pattern.nc))
        products: list[list[tuple[int, str]]] = []
        lines.append("  {")
        for k in group:
            products.append([])
            for run in _points_or_entries(pattern, k):
                name, linear = f"e{run[0]}", [pattern.array["row_lin"][i] for i in run]
                empty = not any(pattern.terms[i] for i in run)
                if of_rates and empty:
                    continue
                lines += _rate_entry(pattern, run, name) if of_rates else _position_entry(pattern, k, run, name, linear)
                columns = [pattern.row_col[i] for i in run]
                products[-1].append((len(run), _as_four(run, f"{name} * {vector('q', columns)}")))
        out, constant = ("gamma", None) if of_rates else ("Phi", "constant")
        lines += _row_sums(group, products, out, constant)[1:]
    return lines


def _points_or_entries(pattern: Pattern, row: int) -> Iterator[Sequence[int]]:
    """Entries of a row in order, three of a point together or one."""
    for run in _runs(pattern, row, 3):
        yield from [run] if len(run) == 3 else [range(i, i + 1) for i in run]


def _type(run: Sequence[int]) -> str:
    return "double" if len(run) == 1 else "four"


def _zero(run: Sequence[int]) -> str:
    return "0.0" if len(run) == 1 else "NONE"


def _as_four(run: Sequence[int], expression: str) -> str:
    return literal([expression]) if len(run) == 1 else expression


def _sum_of_terms(pattern: Pattern, run: Sequence[int], begin: str) -> str:
    """`begin` plus the terms of neighbouring entries, in order."""
    text, count = begin, max(len(pattern.terms[i]) for i in run)
    for m in range(count):
        terms = [pattern.terms[i][m] if m < len(pattern.terms[i]) else None for i in run]
        indices = [None if t is None else t[0] for t in terms]
        columns = [None if t is None else t[1] for t in terms]
        text = f"({text} + {_entries('hess', indices)} * {_entries('q', columns)})"
    return text


def _entries(array: str, indices: Sequence[int | None]) -> str:
    """C vector of entries of an array: as `vector`, but equal indices are not read as one number."""
    if len(indices) > 1 and not are_consecutive(indices):
        return literal(["0.0" if i is None else f"{array}[{i}]" for i in indices])
    return vector(array, indices)


def _position_entry(pattern: Pattern, row: int, run: Sequence[int], name: str, linear: Sequence[float]) -> list[str]:
    zero = all(str(x) == "0.0" for x in linear)
    kind, first = _type(run), run[0]
    lines = [f"  const {kind} {name}j = {_sum_of_terms(pattern, run, _zero(run) if zero else _linear_part(run))};"]
    if len(run) == 1:
        lines.append(f"  J[{first}] = {name}j;")
    else:
        lines.append(f"  {'PUT' if run[-1] + 1 < pattern.row_ptr[row + 1] else 'put3'}(J + {first}, {name}j);")
    # a sum that starts with +0 is never -0, so adding another +0 does not change it
    lines.append(f"  const {kind} {name} = {name}j{'' if zero else ' + ' + _linear_part(run)};")
    return lines


def _linear_part(run: Sequence[int]) -> str:
    if len(run) == 1:
        return f"lin[{run[0]}]"
    return literal([f"lin[{i}]" for i in run])


def _rate_entry(pattern: Pattern, run: Sequence[int], name: str) -> list[str]:
    return [f"  const {_type(run)} {name} = {_sum_of_terms(pattern, run, _zero(run))};"]


_FIRST = {1: "FIRST", 2: "FIRST2", 3: "FIRST3", 4: ""}


def _row_sums(group: range, products: Sequence[Sequence[tuple[int, str]]], out: str, constant: str | None) -> list[str]:
    """Statements for the sums of up to four rows as one vector, each in the order of its own products."""
    lines = ["  {", "  four total = NONE;"]
    for level in range(max((len(row) for row in products), default=0)):
        terms = [row[level] if level < len(row) else (0, "NONE") for row in products] + [(0, "NONE")] * (
            4 - len(products)
        )
        max_length = max(length for length, _ in terms)
        terms_text = [
            text if length in (0, max_length) or length < 3 else f"{_FIRST[length]}({text})" for length, text in terms
        ]
        names = [f"p{level}{c}" for c in "abcd"]
        lines.append("  const four " + ", ".join(f"{n} = {w}" for n, w in zip(names, terms_text, strict=True)) + ";")
        a, b, c, d = names
        lines.append(f"  const four l{level} = LOW({a}, {b}), m{level} = LOW({c}, {d});")
        lines.append(f"  total += NEAR(l{level}, m{level});")
        if max_length > 1:
            lines.append(f"  const four h{level} = HIGH({a}, {b}), i{level} = HIGH({c}, {d});")
            lines.append(f"  total += NEAR(h{level}, i{level});")
        if max_length > 2:
            lines.append(f"  total += FAR(l{level}, m{level});")
        if max_length > 3:
            lines.append(f"  total += FAR(h{level}, i{level});")
    if constant is not None:
        constants = vector(constant, group) if len(group) == 4 else literal([f"{constant}[{k}]" for k in group])
        lines.append(f"  total = {constants} + 0.5 * total;")
    if len(group) == 4:
        lines.append(f"  PUT({out} + {group[0]}, total);")
    else:
        lines += [f"  {out}[{k}] = total[{i}];" for i, k in enumerate(group)]
    return [*lines, "  }"]
