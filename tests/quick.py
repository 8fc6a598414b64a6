"""Cases of a parameter sweep, few of which are in every run of the tests."""

from collections.abc import Collection, Iterable
from typing import Any

import pytest


def quick(few: Collection[Any], cases: Iterable[Any], others: str = "slow") -> list[Any]:
    """`cases` as `pytest.mark.parametrize` takes them; those that are not in `few` carry the marker `others`.

    A slow test whose other cases repeat it on more cars or systems takes "proof"; a case of several values is a tuple.
    """
    mark = getattr(pytest.mark, others)
    return [
        case if case in few else pytest.param(*(case if isinstance(case, tuple) else (case,)), marks=mark)
        for case in cases
    ]
