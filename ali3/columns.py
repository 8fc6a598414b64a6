"""Aligns texts in columns for a terminal, and shortens long lists of names."""

from collections.abc import Container, Iterable, Sequence


def in_columns(rows: Sequence[Sequence[str]], right: Container[int] = ()) -> list[str]:
    """Lines of a table, with two blanks between cells.

    `rows`: cells of the rows, equally many; `right`: indices of the right-aligned columns.
    """
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    justified = [str.rjust if k in right else str.ljust for k in range(len(widths))]
    return ["  ".join(fit(c, w) for fit, c, w in zip(justified, row, widths, strict=True)).rstrip() for row in rows]


def some_of(names: Iterable[str], most: int = 12, between: str = ", ") -> str:
    """The first of some names, and how many more there are; "none" if there are none."""
    listed = list(names)
    more = f" and {len(listed) - most} more" if len(listed) > most else ""
    return (between.join(listed[:most]) or "none") + more
