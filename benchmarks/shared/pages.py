"""Markdown tables, and their replacement in a page between ``<!-- begin NAME -->`` and ``<!-- end NAME -->``."""

import re
import textwrap
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from benchmarks.shared.machine import machine_text

DOCS = Path(__file__).resolve().parents[2] / "docs"
Row = Mapping[str, Any]


def table(rows: Sequence[Row], columns: Mapping[str, str]) -> str:
    """A Markdown table; `columns`: format of each key; None is written as "–"."""

    def cell(value: Any, form: str) -> str:
        if value is None:
            return "–"
        return str(value).replace("|", "\\|") if isinstance(value, str) else format(value, form)

    head = [key.replace("_", " ") for key in columns]
    lines = [head, ["---"] * len(head)] + [[cell(r.get(k), f) for k, f in columns.items()] for r in rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def crossed(
    rows: Sequence[Row], name: Callable[[Row], str], column: str, cell: Callable[[Row], str], title: str
) -> str:
    """A pivot table: a line for each name, a column for each value of the key `column`."""
    lines: dict[str, dict[str, str]] = {}
    for row in rows:
        lines.setdefault(name(row), {title: name(row)})[row[column]] = cell(row)
    return table(list(lines.values()), dict.fromkeys([title, *dict.fromkeys(r[column] for r in rows)], ""))


def machine(meta: Row) -> str:
    """Machine, versions and date in one line, from `describe`."""
    return f"{machine_text(meta)}; {meta['time'][:10]}."


def replace(text: str, blocks: Mapping[str, str]) -> str:
    """Text of a page with new blocks, by name; lines other than rows of tables are wrapped at 120 characters."""
    for name, content in blocks.items():
        mark = re.compile(rf"(<!-- begin {re.escape(name)} -->\n).*?(<!-- end {re.escape(name)} -->)", re.DOTALL)
        text = mark.sub(lambda m, content=content: f"{m[1]}{_wrap(content.strip())}\n{m[2]}", text)
    return text


def _wrap(content: str) -> str:
    """Wrap all lines but rows of tables; further lines of a list item are indented."""
    lines = []
    for line in content.splitlines():
        hang = "  " if line.startswith("- ") else ""
        plain = line and not line.startswith(("|", "!"))
        wrapped = textwrap.wrap(line, 120, subsequent_indent=hang, break_long_words=False, break_on_hyphens=False)
        lines += wrapped if plain else [line]
    return "\n".join(lines)
