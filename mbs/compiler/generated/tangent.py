"""The tangent in front storage, target by target: mass, J' J, second derivatives of rows, B' S B of the elements."""

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

from mbs.compiler.generated import angles
from mbs.compiler.generated.fronts import pieces
from mbs.compiler.generated.pattern import Element, Front, Pattern
from mbs.compiler.generated.text import follow, function, room, vector

FRONT = (
    "APART void tangent{0}_{1}(const ali3_tangent_parts *restrict parts, const double *restrict w, "
    "const double *restrict factor, const double *restrict guide, const double *restrict angle, double *restrict F)"
)
WHOLE = "APART void tangent{0}(const ali3_tangent_parts *restrict parts, double *restrict F)"


@dataclass(frozen=True)
class _Block:
    """Rows of the front by columns of it: coordinates of a point or one each, the rows not above."""

    rows: Sequence[int]
    columns: Sequence[int]


def tangent(pattern: Pattern) -> list[str]:
    """A function for each front, and the function that calls them."""
    lines: list[str] = []
    for front in pattern.fronts:
        lines += _OfFront(pattern, front).function()
    n, guides = len(pattern.row_col), len(pattern.array["gterm_row"])
    body = [
        f"  double w[{n + 1}];",
        room("factor", pattern.nc),
        room("guide", guides),
        f"  for (int i = 0; i < {n}; i++) w[i] = parts->square * parts->J[i];",
        f"  w[{n}] = 0.0;",
        f"  for (int i = 0; i < {pattern.nc}; i++) factor[i] = parts->geometric * parts->lam[i];",
    ]
    for t in range(guides):
        row, g, power = (pattern.array[f"gterm_{name}"][t] for name in ("row", "guide", "power"))
        twice = pattern.array["gterm_a"][t] == pattern.array["gterm_b"][t]
        by = f"parts->gterm_h[{t}] * parts->s[{g}]" + (f" * parts->s[{g}]" if power != 1 else "")
        body.append(f"  guide[{t}] = factor[{row}] * ({by}){' * 2.0' if twice else ''};")
    body += angles.lines(pattern)
    calls = [f"tangent{pattern.suffix}_{front.number}(parts, w, factor, guide, angle, F);" for front in pattern.fronts]
    body += [f"  {call}" for call in calls]
    return lines + function(WHOLE.format(pattern.suffix), body)


class _OfFront:
    """Terms that are summed in one front."""

    def __init__(self, pattern: Pattern, front: Front) -> None:
        self.pattern, self.front = pattern, front
        self.local = {c: i for i, c in enumerate(front.coordinates)}
        self.groups = self._groups()
        self.rows = [k for k, f in enumerate(pattern.array["row_front"]) if f == front.number]
        self.entry = {k: {pattern.row_col[i]: i for i in range(pattern.row_ptr[k], pattern.row_ptr[k + 1])}
                      for k in self.rows}  # fmt: skip
        self.mass = {pattern.place[p][1:] for p in pattern.array["mass_pos"] if p in pattern.place
                     and pattern.place[p][0] == front.number}  # fmt: skip
        self.bends = self._bends()
        self.elements = [e for e in pattern.elements if e.front == front.number]

    def _groups(self) -> list[Sequence[int]]:
        """Places in the front in turn: three of a point, or one."""
        begins = {g[0] for g in self.pattern.groups if len(g) == 3}
        groups: list[Sequence[int]] = []
        i, of = 0, self.front.coordinates
        while i < len(of):
            three = of[i] in begins and of[i + 1 : i + 3] == [of[i] + 1, of[i] + 2]
            groups.append(range(i, i + (3 if three else 1)))
            i += len(groups[-1])
        return groups

    def _bends(self) -> dict[tuple[int, int], list[tuple[str, int, int]]]:
        """Per place the second derivatives of rows, then of terms with guides, then of angles, in turn."""
        pattern = self.pattern
        derivatives: dict[tuple[int, int], list[tuple[str, int, int]]] = defaultdict(list)
        a, b, ptr = (pattern.array[name] for name in ("quad_a", "quad_b", "quad_ptr"))
        for k in self.rows:
            for t in range(ptr[k], ptr[k + 1]):
                at = pattern.row_place(k, pattern.row_ptr[k] + a[t], pattern.row_ptr[k] + b[t])
                derivatives[pattern.place[at][1:]].append(("hess", pattern.quad_place[t], k))
        for t, k in enumerate(pattern.array["gterm_row"]):
            first, second = pattern.array["gterm_a"][t], pattern.array["gterm_b"][t]
            if pattern.array["row_front"][k] == self.front.number and second >= 0:
                at = pattern.row_place(k, pattern.row_ptr[k] + first, pattern.row_ptr[k] + second)
                derivatives[pattern.place[at][1:]].append(("guide", t, -1))
        for number, (row, position) in enumerate(angles.places(pattern)):
            if pattern.array["row_front"][row] == self.front.number:
                derivatives[pattern.place[position][1:]].append(("angle", number, -1))
        return derivatives

    def function(self) -> list[str]:
        """C of the front."""
        lines = ["  const double *J = parts->J, *hess = parts->hess_val, *val = parts->sig_val;",
                 "  (void)J, (void)hess, (void)val, (void)w, (void)factor, (void)guide, (void)angle;"]  # fmt: skip
        self.used: set[str] = set()
        blocks = [self._block(_Block(rows, columns)) for q, columns in enumerate(self.groups)
                  for rows in self.groups[q:]]  # fmt: skip
        for element in self.elements:
            lines += self._products(element)
        return function(
            FRONT.format(self.pattern.suffix, self.front.number),
            [*lines, *(line for block in blocks for line in block)],
        )

    def _entries(self, element: Element) -> dict[int, list[tuple[int, int]]]:
        """Per place in the front the signals and entries of an element there, in turn."""
        entries: dict[int, list[tuple[int, int]]] = defaultdict(list)
        for s, signal in enumerate(element.signals):
            for k in self.pattern.entries(signal):
                entries[self.local[self.pattern.sig_col[k]]].append((s, k))
        return entries

    def _element_groups(self, element: Element) -> list[Sequence[int]]:
        entries = self._entries(element)
        return [g for g in self.groups if any(i in entries for i in g)]

    def _products(self, element: Element) -> list[str]:
        """S B of an element: per signal and group of coordinates a vector."""
        e, n, entries = element.number, len(element.signals), self._entries(element)
        lines = [f"  const double *T{e} = parts->idle[{e}] ? nothing : parts->S + {element.tangent};"]
        for group in self._element_groups(element):
            lists = [entries.get(i, []) for i in group]
            for s in range(n):
                name = f"B{e}_{s}_{group[0]}"
                if name not in self.used:
                    continue
                text = "NONE" if len(group) == 3 else "0.0"
                for m in range(max(map(len, lists))):
                    term = self._term(element, s, [x[m] if m < len(x) else None for x in lists])
                    text = f"({text} + {term})"
                kind = "four" if len(group) == 3 else "double"
                lines.append(f"  const {kind} {name} = {text};")
        return lines

    def _term(self, element: Element, s: int, terms: Sequence[tuple[int, int] | None]) -> str:
        """A tangent of signal s times values, at one coordinate or three."""
        e, n = element.number, len(element.signals)
        present = [t for t in terms if t is not None]
        if len(terms) == 1:
            return f"T{e}[{s * n + present[0][0]}] * val[{present[0][1]}]"
        if len(present) == 3:
            first, k = present[0]
            last = element.tangent + s * n + first + 4 > self._all_tangents()
            offsets = {k - self.pattern.entries(element.signals[i])[0] for i, k in present}
            if element.triple[first] and follow([i for i, _ in present]) and len(offsets) == 1 and not last:
                return f"V(T{e} + {s * n + first}) * val[{k}]"
            same = all(i == first for i, _ in present)
            if same and follow([k for _, k in present]) and k + 4 <= len(self.pattern.sig_val):
                return f"T{e}[{s * n + first}] * V(val + {k})"
        words = ["0.0" if t is None else f"T{e}[{s * n + t[0]}] * val[{t[1]}]" for t in terms]
        return "(four){" + ", ".join([*words, "0.0"]) + "}"

    def _all_tangents(self) -> int:
        return sum(len(e.signals) ** 2 for e in self.pattern.elements if e.front >= 0)

    def _block(self, block: _Block) -> list[str]:
        front, kind = self.front, "four" if len(block.rows) == 3 else "double"
        zero = "NONE" if len(block.rows) == 3 else "0.0"
        at = [front.offset + j * front.size + block.rows[0] for j in block.columns]
        lines = ["  {"]
        for d, j in enumerate(block.columns):
            any_mass = any((i, j) in self.mass for i in block.rows)
            offsets = range(at[d], at[d] + len(block.rows))
            begin = vector("parts->front_mass", offsets, self._storage()) if any_mass else zero
            lines.append(f"  {kind} a{d} = {begin};")
        if block.rows == block.columns:
            lines += self._zeros_above(block)
        lines += self._squares(block) + self._second(block) + self._element_terms(block)
        for d, offset in enumerate(at):
            if kind == "double":
                lines.append(f"  F[{offset}] = a{d};")
            else:
                lines.append(f"  {'PUT' if offset + 4 <= self._storage() else 'put3'}(F + {offset}, a{d});")
        return [*lines, "  }"]

    def _zeros_above(self, block: _Block) -> list[str]:
        """Zeros above the diagonal in whole blocks of four of the factorisation; never read, but they must not grow."""
        front, lines = self.front, []
        for j in block.columns:
            begin = pieces(j, front.size)[0].first
            lines += [f"  F[{front.offset + j * front.size + i}] = 0.0;" for i in range(begin, block.rows[0])]
        return lines

    def _storage(self) -> int:
        return int(self.pattern.array["front_off"][-1])

    def _squares(self, block: _Block) -> list[str]:
        lines, of = [], self.front.coordinates
        for k in self.rows:
            entries = [self.entry[k].get(of[i]) for i in block.rows]
            if not any(e is not None for e in entries):
                continue
            for d, j in enumerate(block.columns):
                column = self.entry[k].get(of[j])
                if column is not None:
                    lines.append(f"  a{d} += w[{column}] * {vector('J', entries)};")
        return lines

    def _second(self, block: _Block) -> list[str]:
        """Statements for the second-order terms: entries on the diagonal of a block together, others one by one."""
        positions = [(i, j) for j in block.columns for i in block.rows if (i, j) in self.bends]
        if not positions:
            return []
        if len(block.rows) == 1 or len(block.columns) == 1:
            return self._single(block, positions)
        diagonal = [(block.rows[d], block.columns[d]) for d in range(3)]
        lists = [self.bends.get(position, []) for position in diagonal]
        lines = []
        if any(lists):
            lines = ["  { four on = DIAGONAL(a0, a1, a2);"]
            for m in range(max(map(len, lists))):
                lines.append(f"    on += {self._bend([x[m] if m < len(x) else None for x in lists])};")
            lines.append("    a0[0] = on[0]; a1[1] = on[1]; a2[2] = on[2]; }")
        return lines + self._single(block, [p for p in positions if p not in diagonal])

    def _bend(self, terms: Sequence[tuple[str, int, int] | None]) -> str:
        present = [t for t in terms if t is not None]
        if len(present) == 3 and len({(t[0], t[2]) for t in present}) == 1 and follow([t[1] for t in present]):
            array, at, k = present[0]
            if array == "hess":
                return f"factor[{k}] * V(hess + {at})"
        words = ["0.0" if t is None else self._number(t) for t in terms]
        return "(four){" + ", ".join([*words, "0.0"]) + "}"

    def _number(self, term: tuple[str, int, int]) -> str:
        array, at, k = term
        return f"factor[{k}] * hess[{at}]" if array == "hess" else f"{array}[{at}]"

    def _single(self, block: _Block, places: Sequence[tuple[int, int]]) -> list[str]:
        lines = []
        for i, j in places:
            lane = f"a{block.columns.index(j)}" + (f"[{block.rows.index(i)}]" if len(block.rows) == 3 else "")
            lines += [f"  {lane} += {self._number(t)};" for t in self.bends[i, j]]
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
                    self.used.add(name)
                    lines.append(f"  a{d} += val[{k}] * {name};")
        return lines
