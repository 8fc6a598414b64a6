"""Summaries of files that were read, as tables of their quantities."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import singledispatch
from typing import Any

from ali3.plausibility.quantity import Quantity
from ali3.plausibility.range_check import Plausibility


@singledispatch
def plausibility_of(thing: Any) -> Sequence[Plausibility]:
    """Plausibility of an object that a reader returns; each package registers this for its types.

    Raises `TypeError`: the package that reads such files was not imported.
    """
    raise TypeError(f"There is no summary for a {type(thing).__name__}; import the package that reads such files.")


class Summarised:
    """An object that a reader returns, with a summary."""

    def summary(self) -> str:
        """What was understood of it: quantities that are known of such things, and where they usually lie.

        Returns
        -------
        str
            A table of text, or several; what lies outside is marked.
        """
        return summary_of(plausibility_of(self))


def summary_of(plausibilities: Sequence[Plausibility]) -> str:
    """Tables of text below their titles; tables of the same quantities are joined as columns."""
    groups: dict[frozenset[Quantity], list[Plausibility]] = {}
    for plausibility in plausibilities:
        if plausibility.values:
            groups.setdefault(frozenset(v.quantity for v in plausibility.values), []).append(plausibility)
    return "\n\n".join(f"{group.title}\n{group.text()}".lstrip("\n") for group in map(_joined, groups.values()))


def _joined(plausibilities: Sequence[Plausibility]) -> Plausibility:
    """Values of several tables as columns of one."""
    first, *others = plausibilities
    if not others:
        return first
    values = [
        replace(v, of=f"{plausibility.title} {v.of}".strip())
        for plausibility in plausibilities
        for v in plausibility.values
    ]
    return Plausibility("", values, kind=first.kind, columns=[plausibility.title for plausibility in plausibilities])


def tables_of(plausibilities: Sequence[Plausibility]) -> dict[str, list[dict[str, Any]]]:
    """Records for JSON by title, whose blanks become underscores."""
    return {plausibility.title.replace(" ", "_"): plausibility.to_json() for plausibility in plausibilities}
