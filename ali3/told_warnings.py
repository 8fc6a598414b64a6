"""Warnings for a user as lines."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager

from ali3.words import shortened


@contextmanager
def told_warnings() -> Iterator[None]:
    """A context in which warnings for a user are lines like errors are, without the place in the source."""

    def show(message: Warning | str, *_: object) -> None:
        print(f"warning: {shortened(str(message))}", file=sys.stderr, flush=True)

    with warnings.catch_warnings():
        warnings.simplefilter("always", UserWarning)
        warnings.showwarning = show  # type: ignore[assignment]
        yield
