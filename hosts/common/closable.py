"""Base class of objects that a ``with`` block closes."""

from abc import ABC, abstractmethod
from typing import NoReturn, Self


class Closable(ABC):
    """Base of what holds a process, an instance or a file."""

    def __reduce_ex__(self, protocol: object) -> NoReturn:
        # a copy would move, and close, the same instance
        raise TypeError(f"A {type(self).__name__} cannot be copied or pickled; make another one.")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @abstractmethod
    def close(self) -> None:
        """Release all resources."""
