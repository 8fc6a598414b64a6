"""Objects that own memory of the kernel."""

from typing import NoReturn


class KernelMemory:
    """Base of objects that own memory of the kernel: a copy would change, and free, the same memory."""

    _reason = "its memory is the kernel's"
    """End of the sentence that refuses a copy."""

    def __reduce_ex__(self, protocol: object) -> NoReturn:
        raise TypeError(f"A {type(self).__name__} cannot be copied or pickled, {self._reason}.")
