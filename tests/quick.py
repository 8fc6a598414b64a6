"""Cases of a sweep, of which few are in every run of the tests and the others only in the slow ones."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import Any

import pytest


def quick(few: Collection[Any], cases: Iterable[Any]) -> list[Any]:
    """`cases` as `pytest.mark.parametrize` takes them; those that are not in `few` carry the marker slow."""
    return [case if case in few else pytest.param(case, marks=pytest.mark.slow) for case in cases]
