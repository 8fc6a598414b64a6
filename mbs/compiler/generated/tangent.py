"""C code of the tangent in front storage: mass, J' J, second derivatives of rows, B' S B of elements."""

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

from mbs.compiler.generated import angles
from mbs.compiler.generated.fronts import pieces
from mbs.compiler.generated.pattern import Element, Front, Pattern
from mbs.compiler.generated.text import are_consecutive, declare_array, function, literal, vector

FRONT = (
    "APART void tangent{0}_{1}(const ali3_tangent_parts *restrict parts, const double *restrict w, "
    "const double *restrict factor, const double *restrict driving, const double *restrict angle, double *restrict F)"
)
WHOLE = "APART void tangent{0}(const ali3_tangent_parts *restrict parts, double *restrict F)"


@dataclass(frozen=True)
class _Block:
    """Rows and columns of a block of the front, on its diagonal or below: each the coordinates of a point, or one."""

    rows: Sequence[int]
    columns: Sequence[int]


def tangent(pattern: Pattern) -> list[str]:
    """A function for each front, and the function that calls them."""
    lines: list[str] = []
    for front in pattern.fronts:
        lines += _FrontTangent(pattern, front).function()
    n, guides = len(pattern.row_col), len(pattern.array["gterm_row"])
    body = [
        f"  double w[{n + 1}];",
        declare_array("factor", pattern.nc),
        declare_array("driving", guides),
        f"  for (int i = 0; i < {n}; i++) w[i] = parts->square * parts->J[i];",
        f"  w[{n}] = 0.0;",
        f"  for (int i = 0; i < {pattern.nc}; i++) factor[i] = parts->geometric * parts->lam[i];",
    ]
    for t in range(guides):
        row, g, power = (pattern.array[f"gterm_{name}"][t] for name in ("row", "guide", "power"))
        is_square = pattern.array["gterm_a"][t] == pattern.array["gterm_b"][t]
        slope = f"parts->gterm_h[{t}] * parts->s[{g}]" + (f" * parts->s[{g}]" if power != 1 else "")
        body.append(f"  driving[{t}] = factor[{row}] * ({slope}){' * 2.0' if is_square else ''};")
    body += angles.lines(pattern)
    calls = [
        f"tangent{pattern.suffix}_{front.number}(parts, w, factor, driving, angle, F);" for front in pattern.fronts
    ]
    body += [f"  {call}" for call in calls]
    return lines + function(WHOLE.format(pattern.suffix), body)


class _FrontTangent:
    """Terms of the tangent in one front."""

    def __init__(self, pattern: Pattern, front: Front) -> None:
        self.pattern, self.front = pattern, front
        self.local = {c: i for i, c in enumerate(front.coordinates)}
        self.groups = self._groups()
        self.rows = [k for k, f in enumerate(pattern.array["row_front"]) if f == front.number]
        self.row_entries = {k: {pattern.row_col[i]: i for i in range(pattern.row_ptr[k], pattern.row_ptr[k + 1])}
                      for k in self.rows}  # fmt: skip
        self.mass = {pattern.front_position[p][1:] for p in pattern.array["mass_pos"] if p in pattern.front_position
                     and pattern.front_position[p][0] == front.number}  # fmt: skip
        self.second_derivatives = self._second_derivatives()
        self.elements = [e for e in pattern.elements if e.front == front.number]

    def _groups(self) -> list[Sequence[int]]:
        """Indices in the front, grouped in order: three of a point, or one."""
        point_starts = {g[0] for g in self.pattern.groups if len(g) == 3}
        groups: list[Sequence[int]] = []
        i, coordinates = 0, self.front.coordinates
        while i < len(coordinates):
            is_point = coordinates[i] in point_starts and coordinates[i + 1 : i + 3] == [
                coordinates[i] + 1,
                coordinates[i] + 2,
            ]
            groups.append(range(i, i + (3 if is_point else 1)))
            i += len(groups[-1])
        return groups

    def _second_derivatives(self) -> dict[tuple[int, int], list[tuple[str, int, int]]]:
        """Second derivatives at each entry: of rows, driving functions, angles in this order; (array, index, row)."""
        pattern = self.pattern
        derivatives: dict[tuple[int, int], list[tuple[str, int, int]]] = defaultdict(list)
        a, b, ptr = (pattern.array[name] for name in ("quad_a", "quad_b", "quad_ptr"))
        for k in self.rows:
            for t in range(ptr[k], ptr[k + 1]):
                position = pattern.product_position(k, pattern.row_ptr[k] + a[t], pattern.row_ptr[k] + b[t])
                derivatives[pattern.front_position[position][1:]].append(("hess", pattern.hess_position[t], k))
        for t, k in enumerate(pattern.array["gterm_row"]):
            first, second = pattern.array["gterm_a"][t], pattern.array["gterm_b"][t]
            if pattern.array["row_front"][k] == self.front.number and second >= 0:
                position = pattern.product_position(k, pattern.row_ptr[k] + first, pattern.row_ptr[k] + second)
                derivatives[pattern.front_position[position][1:]].append(("driving", t, -1))
        for number, (row, position) in enumerate(angles.positions(pattern)):
            if pattern.array["row_front"][row] == self.front.number:
                derivatives[pattern.front_position[position][1:]].append(("angle", number, -1))
        return derivatives

    def function(self) -> list[str]:
        """C function of the front."""
        lines = ["  const double *J = parts->J, *hess = parts->hess_val, *val = parts->sig_val;",
                 "  (void)J, (void)hess, (void)val, (void)w, (void)factor, (void)driving, (void)angle;"]  # fmt: skip
        self.used_products: set[str] = set()
        blocks = [self._block(_Block(rows, columns)) for q, columns in enumerate(self.groups)
                  for rows in self.groups[q:]]  # fmt: skip
        for element in self.elements:
            lines += self._products(element)
        return function(
            FRONT.format(self.pattern.suffix, self.front.number),
            [*lines, *(line for block in blocks for line in block)],
        )

    def _entries(self, element: Element) -> dict[int, list[tuple[int, int]]]:
        """Signals of an element and their entries at each index in the front, in order."""
        entries: dict[int, list[tuple[int, int]]] = defaultdict(list)
        for s, signal in enumerate(element.signals):
            for k in self.pattern.entries(signal):
                entries[self.local[self.pattern.sig_col[k]]].append((s, k))
        return entries

    def _element_groups(self, element: Element) -> list[Sequence[int]]:
        entries = self._entries(element)
        return [g for g in self.groups if any(i in entries for i in g)]

    def _products(self, element: Element) -> list[str]:
        """Declarations of S B of an element: a variable for each signal and group of coordinates."""
        e, n, entries = element.number, len(element.signals), self._entries(element)
        lines = [f"  const double *T{e} = parts->idle[{e}] ? nothing : parts->S + {element.tangent};"]
        for group in self._element_groups(element):
            lists = [entries.get(i, []) for i in group]
            for s in range(n):
                name = f"B{e}_{s}_{group[0]}"
                if name not in self.used_products:
                    continue
                text = "NONE" if len(group) == 3 else "0.0"
                for m in range(max(map(len, lists))):
                    term = self._term(element, s, [x[m] if m < len(x) else None for x in lists])
                    text = f"({text} + {term})"
                kind = "four" if len(group) == 3 else "double"
                lines.append(f"  const {kind} {name} = {text};")
        return lines

    def _term(self, element: Element, s: int, terms: Sequence[tuple[int, int] | None]) -> str:
        """Row s of S times entries of B, at one coordinate or three."""
        e, n = element.number, len(element.signals)
        present = [t for t in terms if t is not None]
        if len(terms) == 1:
            return f"T{e}[{s * n + present[0][0]}] * val[{present[0][1]}]"
        if len(present) == 3:
            first, k = present[0]
            past_end = element.tangent + s * n + first + 4 > self._tangent_count()
            offsets = {k - self.pattern.entries(element.signals[i])[0] for i, k in present}
            if (
                element.triple[first]
                and are_consecutive([i for i, _ in present])
                and len(offsets) == 1
                and not past_end
            ):
                return f"V(T{e} + {s * n + first}) * val[{k}]"
            same_signal = all(i == first for i, _ in present)
            if same_signal and are_consecutive([k for _, k in present]) and k + 4 <= len(self.pattern.sig_val):
                return f"T{e}[{s * n + first}] * V(val + {k})"
        return literal(["0.0" if t is None else f"T{e}[{s * n + t[0]}] * val[{t[1]}]" for t in terms])

    def _tangent_count(self) -> int:
        return sum(len(e.signals) ** 2 for e in self.pattern.elements if e.front >= 0)

    def _block(self, block: _Block) -> list[str]:
        front, kind = self.front, "four" if len(block.rows) == 3 else "double"
        zero = "NONE" if len(block.rows) == 3 else "0.0"
        at = [front.offset + j * front.size + block.rows[0] for j in block.columns]
        lines = ["  {"]
        for d, j in enumerate(block.columns):
            any_mass = any((i, j) in self.mass for i in block.rows)
            offsets = range(at[d], at[d] + len(block.rows))
            begin = vector("parts->front_mass", offsets, self._storage_size()) if any_mass else zero
            lines.append(f"  {kind} a{d} = {begin};")
        if block.rows == block.columns:
            lines += self._zeros_above(block)
        lines += self._row_products(block) + self._second_order(block) + self._element_terms(block)
        for d, offset in enumerate(at):
            if kind == "double":
                lines.append(f"  F[{offset}] = a{d};")
            else:
                lines.append(f"  {'PUT' if offset + 4 <= self._storage_size() else 'put3'}(F + {offset}, a{d});")
        return [*lines, "  }"]

    def _zeros_above(self, block: _Block) -> list[str]:
        """Zeros above the diagonal in whole blocks of four of the factorisation; never read, but they must not grow."""
        front, lines = self.front, []
        for j in block.columns:
            begin = pieces(j, front.size)[0].first
            lines += [f"  F[{front.offset + j * front.size + i}] = 0.0;" for i in range(begin, block.rows[0])]
        return lines

    def _storage_size(self) -> int:
        return int(self.pattern.array["front_off"][-1])

    def _row_products(self, block: _Block) -> list[str]:
        lines, coordinates = [], self.front.coordinates
        for k in self.rows:
            entries = [self.row_entries[k].get(coordinates[i]) for i in block.rows]
            if not any(e is not None for e in entries):
                continue
            for d, j in enumerate(block.columns):
                column = self.row_entries[k].get(coordinates[j])
                if column is not None:
                    lines.append(f"  a{d} += w[{column}] * {vector('J', entries)};")
        return lines

    def _second_order(self, block: _Block) -> list[str]:
        """Statements for the second-order terms: entries on the diagonal of a block together, others one by one."""
        positions = [(i, j) for j in block.columns for i in block.rows if (i, j) in self.second_derivatives]
        if not positions:
            return []
        if len(block.rows) == 1 or len(block.columns) == 1:
            return self._single_terms(block, positions)
        diagonal = [(block.rows[d], block.columns[d]) for d in range(3)]
        lists = [self.second_derivatives.get(position, []) for position in diagonal]
        lines = []
        if any(lists):
            lines = ["  { four on = DIAGONAL(a0, a1, a2);"]
            for m in range(max(map(len, lists))):
                lines.append(f"    on += {self._second_order_vector([x[m] if m < len(x) else None for x in lists])};")
            lines.append("    a0[0] = on[0]; a1[1] = on[1]; a2[2] = on[2]; }")
        return lines + self._single_terms(block, [p for p in positions if p not in diagonal])

    def _second_order_vector(self, terms: Sequence[tuple[str, int, int] | None]) -> str:
        present = [t for t in terms if t is not None]
        if len(present) == 3 and len({(t[0], t[2]) for t in present}) == 1 and are_consecutive([t[1] for t in present]):
            array, at, k = present[0]
            if array == "hess":
                return f"factor[{k}] * V(hess + {at})"
        return literal(["0.0" if t is None else self._second_order_term(t) for t in terms])

    def _second_order_term(self, term: tuple[str, int, int]) -> str:
        array, at, k = term
        return f"factor[{k}] * hess[{at}]" if array == "hess" else f"{array}[{at}]"

    def _single_terms(self, block: _Block, positions: Sequence[tuple[int, int]]) -> list[str]:
        lines = []
        for i, j in positions:
            accumulator = f"a{block.columns.index(j)}" + (f"[{block.rows.index(i)}]" if len(block.rows) == 3 else "")
            lines += [f"  {accumulator} += {self._second_order_term(t)};" for t in self.second_derivatives[i, j]]
        return lines

    def _element_terms(self, block: _Block) -> list[str]:
        lines = []
        for element in self.elements:
            entries = self._entries(element)
            if not any(i in entries for i in block.rows):
                continue
            for d, j in enumerate(block.columns):
                for s, k in entries.get(j, []):
                    name = f"B{element.number}_{s}_{block.rows[0]}"
                    self.used_products.add(name)
                    lines.append(f"  a{d} += val[{k}] * {name};")
        return lines
