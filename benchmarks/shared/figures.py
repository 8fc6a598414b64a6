"""Compares figures and charts of pages with new ones: counts and errors, panels and texts, never times."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal

from ali3.chart_description import description_of
from benchmarks.shared.pages import DOCS, replace

_TABLE = re.compile(r"(?:^\|.*\n?)+", re.MULTILINE)
_NUMBER = re.compile(r"(-?\d+(?:\.\d+)?(?:e[-+]?\d+)?)")
_DIGITS = 3  # of figures that may be one off in the last


@dataclass(frozen=True)
class RemadeTable:
    """A table, a sentence or a chart of a page that was made again."""

    page: str
    """Its file, or that of the chart."""
    text: str
    """Rows of a Markdown table, the sentence that the page must have, or what the chart shows in words."""
    table: str = ""
    """Between which marks the table stands; empty for a sentence."""
    keys: tuple[str, ...] = ()
    """Columns by which a row is found."""
    left_out: tuple[str, ...] = ()
    """Columns that are not compared: times, and what is round-off."""
    picture: bytes = b""
    """The chart as it is drawn now, PNG or SVG."""


def read(page: str) -> str:
    """Text of a page, or what a chart says that it shows."""
    file = DOCS.parent / page
    return description_of(file) if file.suffix in (".png", ".svg") else file.read_text(encoding="utf-8")


def rows_of(text: str) -> list[dict[str, str]]:
    """Rows of the first Markdown table in a text, cells by heading."""
    result = _TABLE.search(text)
    lines = result[0].splitlines() if result else []
    cells = [[c.strip() for c in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines]
    return [dict(zip(cells[0], row, strict=True)) for row in cells[2:]] if cells else []


def between(text: str, table: str) -> str:
    """The text between the marks of a table; empty without them."""
    match = re.search(rf"<!-- begin {re.escape(table)} -->\n(.*?)<!-- end {re.escape(table)} -->", text, re.DOTALL)
    return match[1] if match else ""


def written(again: RemadeTable, text: str) -> str:
    """The text of a page with the cells of a table as they are made; what is left out and other rows stay."""
    block, new_rows = between(text, again.table), rows_of(again.text)
    shown = rows_of(block)
    if not shown or list(shown[0]) != list(new_rows[0]):
        shown = []
    rows = {tuple(row[key] for key in again.keys): row for row in shown}
    for row in new_rows:
        key = tuple(row[k] for k in again.keys)
        kept = {name: cell for name, cell in rows.get(key, {}).items() if name in again.left_out}
        rows[key] = row | kept
    cells = [list(new_rows[0]), ["---"] * len(new_rows[0]), *(list(row.values()) for row in rows.values())]
    table = "".join(f"| {' | '.join(line)} |\n" for line in cells)
    return replace(text, {again.table: _TABLE.sub(lambda _: table, block, count=1) if rows_of(block) else table})


def same(shown: str | None, computed: str) -> bool:
    """Whether two cells say the same; the last of three or more digits of a fraction may be one off, as libraries of
    other machines round it.
    """
    one, other = _NUMBER.split(shown or ""), _NUMBER.split(computed)  # words, number, words, ...
    if len(one) != len(other) or one[::2] != other[::2]:
        return False
    return all(map(_same_number, one[1::2], other[1::2]))


def _same_number(shown: str, computed: str) -> bool:
    if shown == computed:
        return True
    one, other = Decimal(shown).as_tuple(), Decimal(computed).as_tuple()
    digits = min(len(one.digits), len(other.digits))
    if digits < _DIGITS or one.exponent != other.exponent or one.sign != other.sign or "." not in computed:
        return False
    return abs(int("".join(map(str, one.digits))) - int("".join(map(str, other.digits)))) == 1


def differences(again: RemadeTable, text: str) -> list[str]:
    """A sentence for each figure that the text of the page has otherwise, and for each line of words of a chart."""
    if again.picture and not text:
        return [f"{again.page} does not say what it shows; python -m benchmarks.figures --write draws it again."]
    if again.picture:
        shown, current = text.splitlines(), again.text.splitlines()
        gone = [f"{again.page} shows what is not drawn now: {line}" for line in shown if line not in current]
        return gone + [f"{again.page} does not show what is drawn now: {line}" for line in current if line not in shown]
    if not again.table:
        present = " ".join(again.text.split()) in " ".join(text.split())
        return [] if present else [f"{again.page} does not say: {again.text}"]
    place = f"{again.page}, table '{again.table}'"
    shown = {tuple(row.get(key) for key in again.keys): row for row in rows_of(between(text, again.table))}
    rows = rows_of(again.text)
    messages = [] if rows else [f"{place}: there are no rows when it is made again."]
    for row in rows:
        key = tuple(row[k] for k in again.keys)
        page = shown.get(key)
        name = ", ".join(key)
        if page is None:
            messages.append(f"{place} has no row {name}.")
            continue
        messages += [
            f"{place}, row {name}: {column} is {page.get(column)} on the page and {cell} when it is made again."
            for column, cell in row.items()
            if column not in again.left_out and not same(page.get(column), cell)
        ]
    return messages


def all_differences(tables: Sequence[RemadeTable]) -> list[str]:
    """Differences on all pages, a line each."""
    return [line for again in tables for line in differences(again, read(again.page))]
