"""Work with an FMU in a process of its own, which its library may take down."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from contextlib import closing
from pathlib import Path
from typing import Any, TypeVar

from ali3.isolated import Isolated, Lost
from hosts.common.errors import LostProcessError
from hosts.common.numbers import Value

PATIENCE = 300.0
"""s that a step, a start or an end of an FMU may take."""

T = TypeVar("T")
R = TypeVar("R")


def files_of(values: Mapping[str, Value]) -> list[Path]:
    """Files that values of an FMU may name."""
    return [Path(value) for value in values.values() if isinstance(value, str) and Path(value).suffix]


def in_own_process(work: Callable[[T, Callable[[float], None]], R], task: T, answer: Any, reads: Iterable[Path]) -> R:
    """Do one task. `work`, `answer`, `reads`: see `Isolated`. Raises `LostProcessError`: the process has ended."""
    process: Isolated[T, R] = Isolated(work, answer, reads=reads)
    with closing(process):
        done = process.do(task, limit=PATIENCE)
    if isinstance(done, Lost):
        raise LostProcessError(f"The process of the FMU {done.how}.")
    return done
