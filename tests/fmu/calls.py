"""Names and types that tests use to call an FMU."""

from collections.abc import Callable
from typing import Any

import pytest

from tests import kinds

OK, WARNING, DISCARD, ERROR = range(4)
"""Statuses; FMPy itself makes one of the first two."""

FMI_2 = pytest.mark.parametrize("kind", kinds.FMI_2)
"""What FMI 3.0 does not have."""

HostMaker = Callable[..., Any]
"""Of the fixture `host`."""
