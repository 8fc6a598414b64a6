"""Compares counts and errors in tables of pages, and texts in charts, with new ones; times are not compared."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal

from ali3.chart_description import read_description
from benchmarks.shared.pages import DOCS, replace

_TABLE = re.compile(r"(?:^\|.*\n?)+", re.MULTILINE)
_NUMBER = re.compile(r"(-?\d+(?:\.\d+)?(?:e[-+]?\d+)?)")
_DIGITS = 3  # least number of digits of a figure whose last digit may differ by one


@dataclass(frozen=True)
class RemadeTable:
    """A table, a sentence or a chart of a page, computed anew."""

    page: str
    """Path of the page, or of the chart."""
    text: str
    """Markdown table, sentence that the page must contain, or description of the chart."""
    table: str = ""
    """Name of the marks around the table; empty for a sentence."""
    keys: tuple[str, ...] = ()
    """Columns that identify a row."""
    excluded: tuple[str, ...] = ()
    """Columns that are not compared: times and round-off errors."""
    picture: bytes = b""
    """New chart, PNG or SVG."""


def read(page: str) -> str:
    """Text of a page, or the description in a chart file."""
    file = DOCS.parent / page
    return read_description(file) if file.suffix in (".png", ".svg") else file.read_text(encoding="utf-8")


def rows_of(text: str) -> list[dict[str, str]]:
    """Rows of the first Markdown table in a text; cells by column heading."""
    result = _TABLE.search(text)
    lines = result[0].splitlines() if result else []
    cells = [[c.strip() for c in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines]
    return [dict(zip(cells[0], row, strict=True)) for row in cells[2:]] if cells else []


def between(text: str, table: str) -> str:
    """Text between the marks of a table; empty without marks."""
    match = re.search(rf"<!-- begin {re.escape(table)} -->\n(.*?)<!-- end {re.escape(table)} -->", text, re.DOTALL)
    return match[1] if match else ""


def written(remade: RemadeTable, text: str) -> str:
    """Text of a page with the new cells of a table; excluded columns and other rows are unchanged."""
    block, new_rows = between(text, remade.table), rows_of(remade.text)
    old_rows = rows_of(block)
    if not old_rows or list(old_rows[0]) != list(new_rows[0]):
        old_rows = []
    rows = {tuple(row[key] for key in remade.keys): row for row in old_rows}
    for row in new_rows:
        key = tuple(row[k] for k in remade.keys)
        excluded = {name: cell for name, cell in rows.get(key, {}).items() if name in remade.excluded}
        rows[key] = row | excluded
    cells = [list(new_rows[0]), ["---"] * len(new_rows[0]), *(list(row.values()) for row in rows.values())]
    table = "".join(f"| {' | '.join(line)} |\n" for line in cells)
    return replace(text, {remade.table: _TABLE.sub(lambda _: table, block, count=1) if rows_of(block) else table})


def same(old: str | None, new: str) -> bool:
    """Whether two cells are equal; in numbers with a decimal point and three or more digits the last digit may differ
    by one, since libraries round differently on other machines.
    """
    one, other = _NUMBER.split(old or ""), _NUMBER.split(new)  # text, number, text, ...
    if len(one) != len(other) or one[::2] != other[::2]:
        return False
    return all(map(_same_number, one[1::2], other[1::2]))


def _same_number(old: str, new: str) -> bool:
    if old == new:
        return True
    one, other = Decimal(old).as_tuple(), Decimal(new).as_tuple()
    digits = min(len(one.digits), len(other.digits))
    if digits < _DIGITS or one.exponent != other.exponent or one.sign != other.sign or "." not in new:
        return False
    return abs(int("".join(map(str, one.digits))) - int("".join(map(str, other.digits)))) == 1


def differences(remade: RemadeTable, text: str) -> list[str]:
    """A sentence for each figure that differs on the page, and for each line of a chart's description."""
    if remade.picture and not text:
        return [f"{remade.page} does not say what it shows; python -m benchmarks.figures --write draws it again."]
    if remade.picture:
        old, new = text.splitlines(), remade.text.splitlines()
        gone = [f"{remade.page} shows what is not drawn now: {line}" for line in old if line not in new]
        return gone + [f"{remade.page} does not show what is drawn now: {line}" for line in new if line not in old]
    if not remade.table:
        present = " ".join(remade.text.split()) in " ".join(text.split())
        return [] if present else [f"{remade.page} does not say: {remade.text}"]
    location = f"{remade.page}, table '{remade.table}'"
    old_rows = {tuple(row.get(key) for key in remade.keys): row for row in rows_of(between(text, remade.table))}
    rows = rows_of(remade.text)
    messages = [] if rows else [f"{location}: there are no rows when it is made again."]
    for row in rows:
        key = tuple(row[k] for k in remade.keys)
        old_row = old_rows.get(key)
        name = ", ".join(key)
        if old_row is None:
            messages.append(f"{location} has no row {name}.")
            continue
        messages += [
            f"{location}, row {name}: {column} is {old_row.get(column)} on the page and {cell} when it is made again."
            for column, cell in row.items()
            if column not in remade.excluded and not same(old_row.get(column), cell)
        ]
    return messages


def all_differences(tables: Sequence[RemadeTable]) -> list[str]:
    """Sentences on the differences of all tables, sentences and charts."""
    return [line for remade in tables for line in differences(remade, read(remade.page))]
