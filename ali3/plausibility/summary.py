"""What readers return says what was understood of it."""

from collections.abc import Sequence
from dataclasses import replace
from functools import singledispatch
from typing import Any

from ali3.plausibility.quantity import Quantity
from ali3.plausibility.range_check import Echo


@singledispatch
def echo_of(thing: Any) -> Sequence[Echo]:
    """What was understood of a thing; each room registers this for what its readers return.

    Raises `TypeError`: the room that reads such things was not imported.
    """
    raise TypeError(f"There is no summary for a {type(thing).__name__}; import the package that reads such files.")


class Understood:
    """Something that a reader returns."""

    def summary(self) -> str:
        """What was understood of it: quantities that are known of such things, and where they usually lie.

        Returns
        -------
        str
            A table of text, or several; what lies outside is marked.
        """
        return summary_of(echo_of(self))


def summary_of(echoes: Sequence[Echo]) -> str:
    """Tables of text, each below its title; those of the same quantities are columns of one."""
    alike: dict[frozenset[Quantity], list[Echo]] = {}
    for echo in echoes:
        if echo.values:
            alike.setdefault(frozenset(v.quantity for v in echo.values), []).append(echo)
    return "\n\n".join(f"{one.title}\n{one.text()}".lstrip("\n") for one in map(_beside, alike.values()))


def _beside(echoes: Sequence[Echo]) -> Echo:
    first, *others = echoes
    if not others:
        return first
    values = [replace(v, of=f"{echo.title} {v.of}".strip()) for echo in echoes for v in echo.values]
    return Echo("", values, kind=first.kind, columns=[echo.title for echo in echoes])


def tables_of(echoes: Sequence[Echo]) -> dict[str, list[dict[str, Any]]]:
    """The same for JSON: records by title, its blanks as underscores."""
    return {echo.title.replace(" ", "_"): echo.to_json() for echo in echoes}
