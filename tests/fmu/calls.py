"""Names and types that tests use to call an FMU."""

from collections.abc import Callable
from typing import Any

OK, WARNING, DISCARD, ERROR = range(4)
"""Statuses; FMPy itself makes one of the first two."""

HostMaker = Callable[..., Any]
"""Of the fixture `host`."""
