"""Summaries of files that were read, as tables of their quantities."""

from collections.abc import Sequence
from dataclasses import replace
from functools import singledispatch
from typing import Any

from ali3.plausibility.quantity import Quantity
from ali3.plausibility.range_check import Plausibility


@singledispatch
def plausibility_of(subject: object) -> Sequence[Plausibility]:
    """Plausibility of an object that a reader returned; each package registers its types.

    Raises `TypeError` if the package of its type is not imported.
    """
    raise TypeError(f"There is no summary for a {type(subject).__name__}; import the package that reads such files.")


class Summarised:
    """Base of objects that readers return, with a summary."""

    def summary(self) -> str:
        """Table of the quantities of the file and their usual ranges.

        Returns
        -------
        str
            One or more tables; values outside their ranges are marked.
        """
        return summary_of(plausibility_of(self))


def summary_of(plausibilities: Sequence[Plausibility]) -> str:
    """Format tables under their titles; tables of the same quantities become columns of one."""
    groups: dict[frozenset[Quantity], list[Plausibility]] = {}
    for plausibility in plausibilities:
        if plausibility.values:
            groups.setdefault(frozenset(v.quantity for v in plausibility.values), []).append(plausibility)
    return "\n\n".join(f"{group.title}\n{group.text()}".lstrip("\n") for group in map(_join, groups.values()))


def _join(plausibilities: Sequence[Plausibility]) -> Plausibility:
    """Join tables as columns of one."""
    first, *others = plausibilities
    if not others:
        return first
    values = [
        replace(value, of=f"{plausibility.title} {value.of}".strip())
        for plausibility in plausibilities
        for value in plausibility.values
    ]
    return Plausibility("", values, kind=first.kind, columns=[plausibility.title for plausibility in plausibilities])


def tables_of(plausibilities: Sequence[Plausibility]) -> dict[str, list[dict[str, Any]]]:
    """Convert to JSON: records by title, with underscores for blanks."""
    return {plausibility.title.replace(" ", "_"): plausibility.to_json() for plausibility in plausibilities}
