"""C code of the forward and back substitution in the fronts of one System, with sums in the order of the kernel."""

from collections.abc import Sequence

from mbs.compiler.generated.fronts import Piece, pieces
from mbs.compiler.generated.pattern import Front, Pattern
from mbs.compiler.generated.text import are_consecutive, function, literal

LARGE = 12
"""Smallest size of a front whose pivots are eliminated four at a time."""
FOUR_SUMS = 16
"""Smallest size of a front whose sums have four parts."""

FORWARD = "APART void forward_{0}(const double *restrict A, double *restrict b)"
BACK = "APART void back_{0}(const double *restrict A, double *restrict b)"
SOLVE = "APART void solve(const double *restrict F, double *restrict b)"


def solve(pattern: Pattern) -> list[str]:
    """C functions of the forward and the back substitution in each front, and the function that calls them."""
    lines: list[str] = []
    body = []
    for front in pattern.fronts:
        lines += function(FORWARD.format(front.number), _forward(front))
        lines += function(BACK.format(front.number), _back(front))
        body.append(f"  forward_{front.number}(F + {front.offset}, b);")
    body += [f"  back_{front.number}(F + {front.offset}, b);" for front in reversed(pattern.fronts)]
    return lines + function(SOLVE, body)


def _gather(front: Front, piece: Piece) -> str:
    """Expression that reads the unknowns of a piece from b."""
    if not piece.wide:
        return f"b[{front.coordinates[piece.first]}]"
    coordinates = front.coordinates[piece.first : piece.first + 4]
    if are_consecutive(coordinates):
        return f"V(b + {coordinates[0]})"
    return literal([f"b[{c}]" for c in coordinates])


def _scatter(front: Front, piece: Piece, value: str, first: int) -> list[str]:
    """Statements that write the unknowns of a piece, beginning at index `first`, back to b."""
    coordinates = front.coordinates
    if not piece.wide:
        return [f"  b[{coordinates[piece.first]}] = {value};"] if piece.first >= first else []
    rows = [i for i in range(piece.first, piece.first + 4) if i >= first]
    if len(rows) == 4 and are_consecutive([coordinates[i] for i in rows]):
        return [f"  PUT(b + {coordinates[rows[0]]}, {value});"]
    return [f"  b[{coordinates[i]}] = {value}[{i - piece.first}];" for i in rows]


def _forward(front: Front) -> list[str]:
    """Statements of the forward substitution: unknowns of the pivots in order, subtracted from all later ones."""
    n, pivots = front.size, front.pivots
    column_pieces = pieces(0, n)
    lines = [f"  {p.kind} x{p.first} = {_gather(front, p)};" for p in column_pieces]
    p = 0
    while p < pivots:
        remaining = pivots - p
        count = 4 if n >= LARGE and remaining >= 4 else 2 if remaining >= 2 else 1
        lines += _scalars(front, column_pieces, p, count)
        for piece in column_pieces:
            if piece.first + (3 if piece.wide else 0) >= p + count:
                lines.append(f"  x{piece.first} = {_subtract_products(piece, p, count, n)};")
        p += count
    for piece in column_pieces:
        if piece.first + (3 if piece.wide else 0) >= pivots:
            lines += _scatter(front, piece, f"x{piece.first}", pivots)
    return lines


def _scalars(front: Front, column_pieces: Sequence[Piece], p: int, count: int) -> list[str]:
    """Statements for the unknowns of `count` pivots from p on, minus the products with earlier pivots of the group."""

    def element(i: int) -> str:
        piece = next(x for x in column_pieces if x.first <= i < x.first + (4 if x.wide else 1))
        return f"x{piece.first}[{i - piece.first}]" if piece.wide else f"x{piece.first}"

    def factor(k: int, i: int) -> str:
        return f"A[{(p + k) * front.size + p + i}]"

    y = [f"y{p + k}" for k in range(count)]
    values = [element(p)]
    if count > 1:
        values.append(f"{element(p + 1)} - {factor(0, 1)} * {y[0]}")
    if count > 2:
        values.append(f"{element(p + 2)} - ({factor(0, 2)} * {y[0]} + {factor(1, 2)} * {y[1]})")
        values.append(
            f"({element(p + 3)} - ({factor(0, 3)} * {y[0]} + {factor(1, 3)} * {y[1]})) - {factor(2, 3)} * {y[2]}"
        )
    first = front.coordinates[p]
    return [line for k, (name, value) in enumerate(zip(y, values, strict=True))
            for line in (f"  const double {name} = {value};", f"  b[{first + k}] = {name};")]  # fmt: skip


def _subtract_products(piece: Piece, p: int, count: int, n: int) -> str:
    """C expression of a piece minus its products with `count` pivots beginning with p."""
    x = f"x{piece.first}"
    term = [f"{piece.load(f'(A + {(p + k) * n})')} * y{p + k}" for k in range(count)]
    if count == 1:
        return f"{x} - {term[0]}"
    if count == 2:
        return f"{x} - ({term[0]} + {term[1]})"
    return f"({x} - ({term[0]} + {term[1]})) - ({term[2]} + {term[3]})"


def _back(front: Front) -> list[str]:
    return _back_large(front) if front.size >= FOUR_SUMS else _back_small(front)


def _back_small(front: Front) -> list[str]:
    """Statements of the back substitution of a small front: products are added to two sums alternately."""
    n, coordinates = front.size, front.coordinates
    lines = [f"  const double y{i} = b[{coordinates[i]}];" for i in range(front.pivots, n)]
    for p in range(front.pivots - 1, -1, -1):
        sums = ["0.0", "0.0"]
        for i in range(p + 1, n):
            k = (i - p - 1) % 2
            sums[k] = f"({sums[k]} + A[{p * n + i}] * y{i})"
        lines.append(f"  const double y{p} = b[{coordinates[p]}] * A[{p * n + p}] - ({sums[0]} + {sums[1]});")
        lines.append(f"  b[{coordinates[p]}] = y{p};")
    return lines


def _back_large(front: Front) -> list[str]:
    """Statements of the back substitution of a large front: four sums, from the last entry to the first.

    Pivots whose blocks of four begin at the same entry are solved together.
    """
    n, pivots, coordinates = front.size, front.pivots, front.coordinates
    lines = []
    known_blocks = 0  # blocks of four from the end that are known
    for p in range(pivots - 1, -1, -1):
        blocks = (n - p - 1) // 4
        for m in range(known_blocks, blocks):
            lines += _block(front, n - 4 * (m + 1))
        known_blocks = max(known_blocks, blocks)
        first = n - 4 * blocks
        if p == pivots - 1 or (n - p - 1) % 4 == 0:
            lines += _sums(front, p, blocks)
        text = f"s{p}"
        for i in range(first - 1, p, -1):
            value = f"y{i}" if i < pivots else f"b[{coordinates[i]}]"
            text = f"({text} + A[{p * n + i}] * {value})"
        lines.append(f"  const double y{p} = b[{coordinates[p]}] * A[{p * n + p}] - {text};")
        lines.append(f"  b[{coordinates[p]}] = y{p};")
    return lines


def _block(front: Front, first: int) -> list[str]:
    """Statement that declares four solved unknowns as a vector."""
    coordinates, rows = front.coordinates, range(first, first + 4)
    if all(i >= front.pivots for i in rows):
        return [f"  const four x{first} = {_gather(front, Piece(first, True))};"]
    values = [f"y{i}" if i < front.pivots else f"b[{coordinates[i]}]" for i in rows]
    return [f"  const four x{first} = {{{', '.join(values)}}};"]


def _sums(front: Front, p: int, blocks: int) -> list[str]:
    """Statements for the sums of pivot p and of the pivots before it with as many blocks of four."""
    n = front.size
    columns = [c for c in range(p, -1, -1) if (n - c - 1) // 4 == blocks]
    if blocks == 0:
        return [f"  const double s{c} = 0.0;" for c in columns]
    lines = []
    for c in columns:
        text = "NONE"
        for m in range(blocks):
            first = n - 4 * (m + 1)
            text = f"({text} + V(A + {c * n + first}) * x{first})"
        lines.append(f"  const four t{c} = {text};")
    if len(columns) == 1:
        return [*lines, f"  const double s{columns[0]} = sum(t{columns[0]});"]
    names = [f"t{c}" for c in columns] + [f"t{columns[-1]}"] * (4 - len(columns))
    lines.append(f"  const four s{p}s = sums({', '.join(names)});")
    return lines + [f"  const double s{c} = s{p}s[{k}];" for k, c in enumerate(columns)]
