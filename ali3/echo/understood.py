"""What readers return says what was understood of it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import singledispatch
from typing import Any

from ali3.echo.judged import Echo


@singledispatch
def echo_of(thing: Any) -> Sequence[Echo]:
    """What was understood of a thing; each room registers this for what its readers return.

    Raises `TypeError`: the room that reads such things was not imported.
    """
    raise TypeError(
        f"Nothing is known that sums up a {type(thing).__name__}; import the package that reads such files."
    )


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
    """Tables of text, each below its title; those that are alike once, below their titles."""
    titles: dict[str, list[str]] = {}
    for echo in echoes:
        if echo.values:
            titles.setdefault(echo.text(), []).append(echo.title)
    return "\n\n".join(f"{', '.join(filter(None, names))}\n{text}".lstrip("\n") for text, names in titles.items())


def tables_of(echoes: Sequence[Echo]) -> dict[str, list[dict[str, Any]]]:
    """The same for JSON: records by title, its blanks as underscores."""
    return {echo.title.replace(" ", "_"): echo.to_json() for echo in echoes}
