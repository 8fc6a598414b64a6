"""What owns memory of the kernel."""

from __future__ import annotations

from typing import NoReturn


class KernelMemory:
    """Base of what frees memory of the kernel when it goes: a copy would free the same memory."""

    def __reduce_ex__(self, protocol: object) -> NoReturn:
        raise TypeError(f"A {type(self).__name__} cannot be copied or pickled, its memory is the kernel's.")
