"""Waits for a page of ours: `wait_for_function` of playwright has its texts evaluated, which the pages forbid."""

from __future__ import annotations

import time
from typing import Any


def wait_until(page: Any, expression: str, arg: Any = None, timeout: float = 30.0) -> Any:
    """The value of an expression, or of a function of `arg`, once it is true.

    Parameters
    ----------
    page : playwright Page or Frame
    expression : str
    arg : object, optional
    timeout : float
        s.
    """
    end = time.monotonic() + timeout
    if arg is None:  # objects of the page stay there
        expression = f"(() => {{ const it = ({expression}); return typeof it === 'object' ? it !== null : it; }})()"
    while not (value := page.evaluate(expression, arg)):
        assert time.monotonic() < end, f"not within {timeout:g} s: {expression}"
        page.wait_for_timeout(20)
    return value
