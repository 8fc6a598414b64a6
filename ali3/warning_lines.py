"""Formats warnings for a user, one a line."""

import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager

from ali3.message_text import shortened


@contextmanager
def warning_lines() -> Iterator[list[str]]:
    """Context in which warnings for a user are printed as lines without the location in the source.

    Yields the list of the warnings so far.
    """
    lines: list[str] = []

    def show(message: Warning | str, *_: object) -> None:
        lines.append(shortened(str(message)))
        print(f"warning: {lines[-1]}", file=sys.stderr, flush=True)

    with warnings.catch_warnings():
        warnings.simplefilter("always", UserWarning)
        warnings.showwarning = show  # type: ignore[assignment]
        yield lines
