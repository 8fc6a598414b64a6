"""Work with an FMU in a process of its own, which its library may take down."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from typing import Any, TypeVar

from ali3.isolated import Isolated, Lost
from hosts.common.errors import LostProcessError

PATIENCE = 300.0
"""s that a step, a start or an end of an FMU may take."""

T = TypeVar("T")
R = TypeVar("R")


def in_own_process(work: Callable[[T, Callable[[float], None]], R], task: T, answer: Any) -> R:
    """Do one task. `work`, `answer`: see `Isolated`. Raises `LostProcessError`: the process has ended before."""
    process: Isolated[T, R] = Isolated(work, answer)
    with closing(process):
        done = process.do(task, limit=PATIENCE)
    if isinstance(done, Lost):
        raise LostProcessError(f"The process of the FMU {done.how}.")
    return done
