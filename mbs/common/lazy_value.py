"""Value that is computed when it is first used."""

import threading
from collections.abc import Callable
from typing import Generic, TypeVar

T = TypeVar("T")
_ONE_AT_A_TIME = threading.RLock()


class LazyValue(Generic[T]):
    """A value that takes time and is not always wanted: the first call makes it, later ones return it.

    `make`: makes the value; called once, or again where it has raised.
    """

    def __init__(self, make: Callable[[], T]) -> None:
        self._make: Callable[[], T] | None = make
        self._made: T | None = None

    def __call__(self) -> T | None:
        """The value; None to what asks while it is being made."""
        with _ONE_AT_A_TIME:
            if self._make is not None:
                make, self._make = self._make, None
                try:
                    self._made = make()
                except BaseException:
                    self._make = make
                    raise
            return self._made
