"""Linear algebra in one thread: the last bits of BLAS depend on how many threads share a product."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import ContextDecorator
from functools import cache
from threading import Lock
from types import TracebackType

import scipy.linalg  # noqa: F401  (loads SciPy's own BLAS, which `_libraries` must find)
from threadpoolctl import ThreadpoolController


class _OneThread(ContextDecorator):
    """Context and decorator in which the BLAS of the wheels of NumPy and SciPy has one thread, in the whole process.

    It has no effect on an OpenBLAS that uses OpenMP, nor while another thread holds a limit of threadpoolctl.

    Contexts may be nested and entered by several threads at once: the last to end gives the threads back.
    """

    def __init__(self) -> None:
        self._lock, self._depth = Lock(), 0

    def __enter__(self) -> None:
        with self._lock:
            if self._depth == 0:
                _run_in_a_new_thread(self._restrict)
            self._depth += 1

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with self._lock:
            self._depth -= 1
            if self._depth == 0:
                _run_in_a_new_thread(self._limit.restore_original_limits)

    def _restrict(self) -> None:
        self._limit = _libraries().limit(limits=1, user_api="blas")


def _run_in_a_new_thread(change: Callable[[], None]) -> None:
    """While the thread that set a limit lives, threadpoolctl ignores other threads."""
    with ThreadPoolExecutor(1) as pool:
        pool.submit(change).result()


@cache
def _libraries() -> ThreadpoolController:
    return ThreadpoolController()


in_one_thread = _OneThread()
