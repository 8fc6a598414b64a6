"""Value that is computed at first use."""

import threading
from collections.abc import Callable
from typing import Generic, TypeVar

T = TypeVar("T")
_LOCK = threading.RLock()


class LazyValue(Generic[T]):
    """Value that is computed by the first call and returned by later ones.

    `make`: computes the value; called once, or again after an error.
    """

    def __init__(self, make: Callable[[], T]) -> None:
        self._make: Callable[[], T] | None = make
        self._value: T | None = None

    def __call__(self) -> T | None:
        """The value; None in a call that `make` itself makes."""
        with _LOCK:
            if self._make is not None:
                make, self._make = self._make, None
                try:
                    self._value = make()
                except BaseException:
                    self._make = make
                    raise
            return self._value
