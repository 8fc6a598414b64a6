"""The summary that each reader returns: how the content of a file was interpreted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import singledispatch
from typing import Any

from ali3.plausibility.quantity import Quantity
from ali3.plausibility.range_check import Plausibility


@singledispatch
def plausibility_of(thing: Any) -> Sequence[Plausibility]:
    """What was understood of a thing; each room registers this for what its readers return.

    Raises `TypeError`: the room that reads such things was not imported.
    """
    raise TypeError(f"There is no summary for a {type(thing).__name__}; import the package that reads such files.")


class Summarised:
    """An object that a reader returns, with a plausibility summary."""

    def summary(self) -> str:
        """What was understood of it: quantities that are known of such things, and where they usually lie.

        Returns
        -------
        str
            A table of text, or several; what lies outside is marked.
        """
        return summary_of(plausibility_of(self))


def summary_of(plausibilities: Sequence[Plausibility]) -> str:
    """Tables of text, each below its title; those of the same quantities are columns of one."""
    groups: dict[frozenset[Quantity], list[Plausibility]] = {}
    for plausibility in plausibilities:
        if plausibility.values:
            groups.setdefault(frozenset(v.quantity for v in plausibility.values), []).append(plausibility)
    return "\n\n".join(f"{group.title}\n{group.text()}".lstrip("\n") for group in map(_beside, groups.values()))


def _beside(plausibilities: Sequence[Plausibility]) -> Plausibility:
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
    """The same for JSON: records by title, its blanks as underscores."""
    return {plausibility.title.replace(" ", "_"): plausibility.to_json() for plausibility in plausibilities}
