"""Linear algebra in one thread: the last bits of BLAS depend on how many threads share a product."""

from __future__ import annotations

from contextlib import ContextDecorator
from functools import cache
from threading import Lock
from types import TracebackType

import scipy.linalg  # noqa: F401  (loads SciPy's own BLAS, which `_libraries` must find)
from threadpoolctl import ThreadpoolController


class _OneThread(ContextDecorator):
    """Context and decorator in which BLAS has one thread, in the whole process.

    Contexts may be nested and entered by several threads at once: the last to end gives the threads back.
    """

    def __init__(self) -> None:
        self._lock, self._depth = Lock(), 0

    def __enter__(self) -> None:
        with self._lock:
            if self._depth == 0:
                self._limit = _libraries().limit(limits=1, user_api="blas")
            self._depth += 1

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with self._lock:
            self._depth -= 1
            if self._depth == 0:
                self._limit.restore_original_limits()


@cache
def _libraries() -> ThreadpoolController:
    return ThreadpoolController()


in_one_thread = _OneThread()
