"""Tables of the pages of the System file and of the statuses, from the kernel's C headers."""

import re

from mbs.kernel.read_headers import ARRAYS, PUBLIC, arrays, sensor_types, table

TABLE_PREFIXES = ("flex_", "tree_", "mode_")
"""Prefixes of the arrays that have separate tables."""
_ITEMS = {"INTEGERS": "i", "REALS": "f", "BYTES": "bytes"}
_SUBSTITUTIONS = (
    (r"ANY|RELATED_LENGTH", "any"),
    (r"OR_NONE\((.+)\)", r"\1 or 0"),
    (r"IF_ANY\((.+), (.+)\)", r"\2, or 0 without \1"),
    (r"ANY_IF\((.+)\)", r"any, or 0 without \1"),
    (r"RELATED|FINITE|TEXT|.*ALI3_.*", ""),
    (r"OR_INFINITE", "may be infinite"),
    (r"BELOW\(2\)", "0 or 1"),
    (r"BELOW\((.+)\)", r"0 to \1 - 1"),
    (r"WITHIN\((.+), (.+)\)", r"\1 to \2"),
    (r"OFFSETS\((\w+)\)", r"offsets in `\1`"),
    (r"ASCENDING", "offsets"),
)
"""Texts of the page for lengths and values; empty if the meaning of the array implies them."""


def _spell_out(text: str) -> str:
    return next(
        (found.expand(words) for pattern, words in _SUBSTITUTIONS if (found := re.fullmatch(pattern, text))), text
    )


def array_table(prefix: str = "") -> str:
    """A table of arrays of the page of the System file, Markdown: those with a prefix, or those in no such table."""
    rows = [
        f"| `{a.name}` | {_ITEMS[a.items]} {_spell_out(a.length)}{', may be missing' * (a.presence == 'MAY')} "
        f"| {_spell_out(a.values)} | {a.words.replace('|', chr(92) + '|')} |"
        for a in arrays()
        if (a.name.startswith(prefix) if prefix else not a.name.startswith(TABLE_PREFIXES))
    ]
    return "\n".join(["| name | type, length | values | meaning |", "| --- | --- | --- | --- |", *rows])


def size_table() -> str:
    """The table of sizes of the page of the System file, Markdown."""
    rows = (
        f"| `{name}` | {words} | items of `{array}`{'' if each == '1' else ' / ' + each} |"
        for name, array, each, words in table(ARRAYS, "ALI3_SYSTEM_SIZES")
    )
    return "\n".join(["| size | number of | is |", "| --- | --- | --- |", *rows])


def status_table() -> str:
    """The table of statuses of a page, Markdown."""
    statuses = enumerate(table(PUBLIC, "ALI3_STATUSES"))
    rows = (f"| {number} | {name} | {words} | {remedy} |" for number, (name, _, words, remedy) in statuses)
    return "\n".join(["| status | name | words | remedy |", "| --- | --- | --- | --- |", *rows])


def sensor_table() -> str:
    """The table of sensors of the page of the System file, Markdown."""
    rows = (f"| {t.number} | {t.name} | {' | '.join(t.words)} |" for t in sensor_types())
    return "\n".join(["| type | name | ints | reals | value |", "| --- | --- | --- | --- | --- |", *rows])
