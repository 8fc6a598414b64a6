"""C code of the factorisation, a function for each shape of a front, with sums in the order of the kernel."""

from collections.abc import Sequence
from dataclasses import dataclass

from mbs.compiler.generated.pattern import Front, Pattern
from mbs.compiler.generated.text import function

PANEL = 4
"""Largest number of pivots that are eliminated together."""
ELIMINATE = (
    "APART int eliminate_{0}_{1}(double *restrict A, const double *restrict floor, int32_t *restrict negative, "
    "double *restrict pivot)"
)
FACTORISE = (
    "APART int32_t factorise(double *restrict F, const double *restrict floor, int32_t *restrict negative, "
    "double *restrict pivot)"
)


@dataclass(frozen=True)
class Piece:
    """Rows of a column in one variable: four neighbours, counted from the end of the column, or one."""

    first: int
    wide: bool

    @property
    def kind(self) -> str:
        """C type of the variable."""
        return "four" if self.wide else "double"

    def load(self, column: str) -> str:
        """C expression that reads the piece from a column."""
        return f"V({column} + {self.first})" if self.wide else f"{column}[{self.first}]"

    def store(self, column: str, value: str) -> str:
        """C statement that writes `value` to the piece of a column."""
        return f"  PUT({column} + {self.first}, {value});" if self.wide else f"  {column}[{self.first}] = {value};"


def pieces(first: int, size: int) -> list[Piece]:
    """Pieces of the rows `first` to `size` - 1; the first piece may begin up to three rows above."""
    begin = size - 4 * ((size - first + 3) // 4)
    if begin >= 0:
        return [Piece(i, True) for i in range(begin, size, 4)]
    return [Piece(i, False) for i in range(first, begin + 4)] + [Piece(i, True) for i in range(begin + 4, size, 4)]


def factorise(pattern: Pattern) -> list[str]:
    """C functions that eliminate fronts of each shape, and the function that factorises all fronts."""
    lines: list[str] = []
    for size, pivots in sorted({(f.size, f.pivots) for f in pattern.fronts}):
        lines += _Shape(size, pivots).eliminate()
    body, first = ["  int bad;"], 0
    for front in pattern.fronts:
        name = f"eliminate_{front.size}_{front.pivots}"
        body.append(f"  bad = {name}(F + {front.offset}, floor + {first}, negative, pivot);")
        body.append(f"  if (bad >= 0) return {first} + bad;")
        first += front.pivots
        if front.parent >= 0:
            body += _assemble(front, pattern.fronts[front.parent])
    return lines + function(FACTORISE, [*body, "  return -1;"])


def _assemble(front: Front, parent: Front) -> list[str]:
    """C that adds the Schur complement of a front to its parent."""
    lines = ["  {", f"  const double *from = F + {front.offset};", f"  double *to = F + {parent.offset};"]
    for j in range(front.pivots, front.size):
        source, target = j * front.size, front.parent_index[j] * parent.size
        i = j
        while i < front.size:
            length = 1
            while i + length < front.size and front.parent_index[i + length] == front.parent_index[i] + length:
                length += 1
            lines += _add(target + front.parent_index[i], source + i, length)
            i += length
    return [*lines, "  }"]


def _add(to: int, source: int, length: int) -> list[str]:
    """C that adds `length` numbers from `source` to `to`, four, two and one at a time."""
    lines = []
    while length > 0:
        step = 4 if length >= 4 else 2 if length >= 2 else 1
        kind = {4: "four", 2: "two", 1: "double"}[step]
        lines.append(f"  *({kind} *)(to + {to}) += *(const {kind} *)(from + {source});")
        to, source, length = to + step, source + step, length - step
    return lines


class _Shape:
    """Elimination in fronts of one shape, in panels of four pivots and a last one of up to three."""

    def __init__(self, size: int, pivots: int) -> None:
        self.size, self.pivots = size, pivots
        self.panels = [(s, min(PANEL, pivots - s)) for s in range(0, pivots, PANEL)]

    def eliminate(self) -> list[str]:
        """C function that returns the first bad pivot, or -1."""
        lines = []
        for q, (start, count) in enumerate(self.panels):
            for j in range(start, start + count):
                lines += self._column(j, q)
            lines += self._triangle(start, count)
            lines += self._columns_below(q, start, count)
        for j in range(self.pivots, self.size):
            lines += self._column(j, len(self.panels))
        return function(ELIMINATE.format(self.size, self.pivots), [*lines, "  return -1;"])

    def _rows_below(self, start: int, count: int) -> list[Piece]:
        return pieces(start + count, self.size)

    def _column(self, j: int, panels: int) -> list[str]:
        """Subtract the panels before column j from it."""
        if panels == 0:
            return []
        column_pieces, lines = pieces(j, self.size), ["  {", f"  double *restrict c = A + {j * self.size};"]
        lines += [f"  {p.kind} t{p.first} = {p.load('c')};" for p in column_pieces]
        for q in range(panels):
            start, count = self.panels[q]
            f = [f"f{q}_{k}" for k in range(count)]
            factors = ", ".join(f"{name} = A[{(start + k) * self.size + j}]" for k, name in enumerate(f))
            lines.append(f"  const double {factors};")
            for p in column_pieces:
                lines.append(f"  t{p.first} = {self._subtract_panel(f't{p.first}', q, p, f)};")
        lines += [p.store("c", f"t{p.first}") for p in column_pieces]
        return [*lines, "  }"]

    def _subtract_panel(self, value: str, q: int, piece: Piece, f: Sequence[str]) -> str:
        """C expression of a value minus the products with panel q."""
        u = [f"u{q}_{k}_{piece.first}" for k in range(len(f))]
        if len(f) == PANEL:
            return f"{value} - (({f[0]} * {u[0]} + {f[1]} * {u[1]}) + ({f[2]} * {u[2]} + {f[3]} * {u[3]}))"
        for name, x in zip(f, u, strict=True):
            value = f"({value} - {name} * {x})"
        return value

    def _triangle(self, start: int, count: int) -> list[str]:
        """Factorise the pivots of a panel among themselves: 1/D and L as C variables, which `_columns_below` stores."""
        n, lines = self.size, []
        for p in range(count):
            for i in range(p, count):
                value = f"A[{(start + p) * n + start + i}]"
                for k in range(p):
                    value = f"({value} - l{start}_{p}{k} * d{start}_{k}{i})"
                lines.append(f"  const double d{start}_{p}{i} = {value};")
            d = f"d{start}_{p}{p}"
            lines.append(f"  if (!good({d}, floor[{start + p}])) {{ *pivot = {d}; return {start + p}; }}")
            lines.append(f"  *negative += {d} < 0.0;")
            lines.append(f"  const double l{start}_{p}{p} = 1.0 / {d};")
            lines += [f"  const double l{start}_{i}{p} = d{start}_{p}{i} * l{start}_{p}{p};"
                      for i in range(p + 1, count)]  # fmt: skip
        return lines

    def _columns_below(self, q: int, start: int, count: int) -> list[str]:
        """Columns of a panel below its pivots: unscaled as C variables u, and L in storage."""
        n, lines = self.size, []
        for p in range(count):
            column = f"(A + {(start + p) * n})"
            for piece in self._rows_below(start, count):
                value = piece.load(column)
                for k in range(p):
                    value = f"({value} - l{start}_{p}{k} * u{q}_{k}_{piece.first})"
                name = f"u{q}_{p}_{piece.first}"
                lines.append(f"  const {piece.kind} {name} = {value};")
                lines.append(piece.store(column, f"{name} * l{start}_{p}{p}"))
            lines += [f"  A[{(start + p) * n + start + i}] = l{start}_{i}{p};" for i in range(p, count)]
        return lines
