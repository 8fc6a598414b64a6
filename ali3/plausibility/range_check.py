"""Compares quantities of a file with their usual ranges, and writes a sentence for each one outside."""

import math
import warnings
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ali3.columns import in_columns
from ali3.plausibility.quantity import WIDEST, Quantity, Range
from ali3.units import typeset

ROUNDING = 1e-9  # of the range
MIN_OTHERS = 10  # values beside a far one
# In a sentence:
MAX_KEYS = 3
MAX_CAUSES = 4
MAX_OTHERS = 1
MAX_LIST = 4
MAX_SHOWN = 10  # values in a cell of the table


@dataclass(frozen=True)
class Value:
    """Value of a quantity of a part of the file."""

    quantity: Quantity
    value: float
    """In the unit of the quantity."""
    keys: Mapping[str, Any] = field(default_factory=dict)
    """Values in the file that it follows from, by key path."""
    of: str = ""
    """Part of the object if there are several, such as "front"."""

    @property
    def name(self) -> str:
        """Part and quantity."""
        return f"{self.of} {self.quantity.name}".strip()

    def inside(self, kind: str = WIDEST) -> bool:
        """Whether the value lies in the range of a kind of object; true without a range."""
        return self._within(self.quantity.range(kind))

    def mended(self, kind: str = WIDEST) -> bool:
        """Whether the value lies in the range that the correction of a mistake must reach."""
        return self._within(self.quantity.near or self.quantity.range(kind))

    def _within(self, bounds: Range | None) -> bool:
        if bounds is None:
            return True
        tolerance = ROUNDING * (bounds[1] - bounds[0]) if math.isfinite(bounds[1] - bounds[0]) else 0.0
        return bool(bounds[0] - tolerance <= self.value <= bounds[1] + tolerance)


Undo: TypeAlias = Callable[[], "Sequence[Value] | None"]


@dataclass(frozen=True)
class Mistake:
    """A common mistake that a file may have."""

    words: str
    """Such as "degrees instead of radians in front.alignment.toe_left"."""
    keys: frozenset[str]
    """Keys that it changes; it is tried if a value outside its range follows from one of them."""
    undo: Undo
    """Computes the values of the file without the mistake; None if the mistake is not possible."""
    guessed: bool = False
    """Whether it is fitted to the values, such as a factor: it is named only if no other mistake explains the same."""


@dataclass(frozen=True)
class Plausibility:
    """Quantities of a file compared with their usual ranges.

    `values` are in the order of the table; the most common `mistakes` are first.
    """

    what: str
    """Name of the file in messages."""
    values: Sequence[Value]
    mistakes: Sequence[Mistake] = ()
    kind: str = WIDEST
    """Key of the ranges."""
    title: str = ""
    """Title of the table if a file has several."""
    columns: Sequence[str] = ()
    """First words of `Value.of` that have their own column, such as front and rear."""

    @property
    def outside(self) -> list[Value]:
        """Values outside their ranges."""
        return [v for v in self.values if not v.inside(self.kind)]

    def text(self) -> str:
        """The table: a row for each quantity, with values, usual range, and a mark if a value is outside.

        Quantities in `columns` are below the quantities of the whole object.
        """
        n = max(len(self.columns), 1)
        rows, column_rows = [], []
        for q in dict.fromkeys(v.quantity for v in self.values):
            row_values = [v for v in self.values if v.quantity is q]
            is_inside = all(v.inside(self.kind) for v in row_values)
            if q.shown_outside and is_inside:
                continue
            range_cells = (_range_text(q, self.kind), "" if is_inside else "<- outside")
            cells = [_cell([v for v in row_values if v.of.startswith(side)], side) for side in self.columns]
            if any(cells):
                column_rows.append((q.name, *cells, *range_cells))
            else:
                rows.append((q.name, _cell(row_values), *[""] * (n - 1), *range_cells))
        if rows:
            rows.insert(0, ("quantity", "value", *[""] * (n - 1), "usual", ""))
        if column_rows:
            column_rows.insert(0, ("" if rows else "quantity", *self.columns, "" if rows else "usual", ""))
        return "\n".join(in_columns(rows + column_rows))

    def to_json(self) -> list[dict[str, Any]]:
        """A record for each value: name, of, symbol, unit, value, range (None: open), inside, follows, keys, source."""
        return [
            {
                "name": v.quantity.name,
                "of": v.of,
                "symbol": v.quantity.symbol,
                "unit": v.quantity.unit,
                "value": float(v.value) if math.isfinite(v.value) else None,
                "range": _json_range(v.quantity.range(self.kind)),
                "inside": v.inside(self.kind),
                "follows": v.quantity.follows,
                "keys": {
                    key: value if isinstance(value, (int, float)) else str(value) for key, value in v.keys.items()
                },
                "source": v.quantity.source,
            }
            for v in self.values
        ]

    def warnings(self) -> list[str]:
        """A sentence for each cause.

        A mistake is named if its correction brings all values that follow from its keys into their ranges, and no
        value out of its range; of several mistakes those that correct most values. The remaining values have one
        sentence for each group with common keys.
        """
        outside, sentences = self.outside, []
        corrections = _correct(self.mistakes, outside)
        while outside:
            names = {v.name for v in outside}
            corrected_names = [
                (m, corrected, self._corrected_names(names, corrected, m.keys)) for m, corrected in corrections
            ]
            best_names = max((names for *_, names in corrected_names), key=len, default=frozenset())
            if not best_names:
                break
            explanations = [(m, corrected) for m, corrected, names in corrected_names if names == best_names]
            candidates = [(m, corrected) for m, corrected in explanations if not m.guessed] or explanations
            causes, corrected = [m.words for m, _ in candidates][:MAX_CAUSES], candidates[0][1]
            first_value = next(v for v in outside if v.name in best_names)
            value = next(v for v in corrected if v.name == first_value.name)
            cause = f"{' or '.join(causes)} would explain it: without that it is {value.quantity.shown(value.value)}"
            sentences.append(self._sentence([v for v in outside if v.name in best_names], cause))
            outside = [v for v in outside if v.name not in best_names]
        for group in _groups_with_common_keys(outside):  # values that follow from the fewest keys are the most specific
            sentences.append(self._sentence(sorted(group, key=lambda v: len(v.keys)), ""))
        return sentences

    def warn(self, category: type[Warning], stacklevel: int = 2) -> None:
        """Warn with each of the sentences. `stacklevel`: 1 is the caller."""
        for sentence in self.warnings():
            warnings.warn(sentence, category, stacklevel=stacklevel + 1)

    def _corrected_names(self, names: set[str], after: Sequence[Value], changed: frozenset[str]) -> frozenset[str]:
        """Names of values outside their ranges that a mistake explains: they are inside after its correction.

        None, if a value that follows from the changed keys is outside afterwards or leaves the range of corrections,
        or if another value leaves its range. Values that share an unchanged key with one still outside are left out.
        """
        outside_before = {v.name for v in self.outside}
        outside_after = {v.name for v in after if not v.inside(self.kind)}
        affected = {v.name for v in self.values if changed & set(v.keys)}
        marginal = {v.name for v in self.values if v.inside(self.kind) and not v.mended(self.kind)}
        outside_after |= {v.name for v in after if v.name in affected - marginal and not v.mended(self.kind)}
        corrected_names = (names & {v.name for v in after}) - outside_after
        outside_keys = {key for v in self.outside if v.name not in corrected_names for key in v.keys} - changed
        corrected_names -= {v.name for v in self.outside if outside_keys & set(v.keys)}
        return frozenset() if outside_after & affected or outside_after - outside_before else frozenset(corrected_names)

    def _sentence(self, group: Sequence[Value], cause: str) -> str:
        first, q = group[0], group[0].quantity
        keys = {key: value for v in group for key, value in v.keys.items()}
        key_texts = [f"{key} = {_value_text(value)}" for key, value in list(keys.items())[:MAX_KEYS]]
        more_keys = f" and {len(keys) - MAX_KEYS} more" if len(keys) > MAX_KEYS else ""
        sentence = f"{first.name} is {q.shown(first.value)}; usual is {_range_text(q, self.kind)}"
        sentence += f"; {cause}" if cause else ""
        if len(group) > 1:
            others = (f"{v.name} {v.quantity.shown(v.value)} ({_range_text(v.quantity, self.kind)})" for v in group[1:])
            and_others = f" and {len(group) - 1 - MAX_OTHERS} more" if len(group) - 1 > MAX_OTHERS else ""
            sentence += f"; outside too: {', '.join(list(others)[:MAX_OTHERS])}{and_others}"
        sentence += "."
        sentence += f" It follows from {', '.join(key_texts)}{more_keys}." if key_texts else ""
        return (f"{self.what}: " if self.what else "") + sentence


def far_values(values: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Mark values, shape (n,), that equal one value farther from all others than ten times the range of these."""
    levels = np.unique(values)
    for level, remaining in ((levels[0], levels[1:]), (levels[-1], levels[:-1])):
        if len(remaining) >= MIN_OTHERS and np.abs(level - remaining).min() > 10.0 * np.ptp(remaining) > 0.0:
            return np.asarray(values == level)
    return np.zeros(values.shape, bool)


def _correct(mistakes: Iterable[Mistake], outside: Sequence[Value]) -> list[tuple[Mistake, Sequence[Value]]]:
    keys = {key for v in outside for key in v.keys}
    pairs = ((m, m.undo()) for m in mistakes if m.keys & keys)
    return [(m, corrected) for m, corrected in pairs if corrected is not None]


def _groups_with_common_keys(values: Sequence[Value]) -> list[list[Value]]:
    """Groups of values that share a key with the first value of the group, or have its quantity."""
    repeated = {q for q, times in Counter(v.quantity for v in values).items() if times > 1}
    groups: list[list[Value]] = []
    for v in values:
        for group in groups:
            if set(group[0].keys) & set(v.keys) or (v.quantity in repeated and v.quantity is group[0].quantity):
                group.append(v)
                break
        else:
            groups.append([v])
    return groups


def _cell(values: Sequence[Value], column: str = "") -> str:
    """Cell of the table for values of one quantity; of many only the ends. `column`: first word of their `of`."""
    if not values:
        return ""
    unit = f" {typeset(values[0].quantity.unit)}".rstrip()
    if len(values) > MAX_SHOWN:
        ends = (choose(values, key=lambda v: v.value) for choose in (min, max))
        return f"{' to '.join(f'{v.value:.4g}{unit} ({v.of})' for v in ends)} of {len(values)}"
    return ", ".join(f"{v.of.removeprefix(column).strip()} {v.value:.4g}".strip() for v in values) + unit


def _json_range(limits: Range | None) -> list[float | None] | None:
    return None if limits is None else [end if math.isfinite(end) else None for end in limits]


def _range_text(quantity: Quantity, kind: str) -> str:
    bounds = quantity.range(kind)
    if bounds is None:
        return ""
    unit = f" {typeset(quantity.unit)}".rstrip()
    low, high = bounds
    if math.isinf(high):
        return f"{low:g}{unit} or more"
    return f"{high:g}{unit} or less" if math.isinf(low) else f"{low:g} to {high:g}{unit}"


def _value_text(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join([*map(_value_text, value[:MAX_LIST]), *["..."] * (len(value) > MAX_LIST)]) + "]"
    return str(value)
