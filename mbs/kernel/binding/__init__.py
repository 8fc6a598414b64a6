"""Binding of the kernel through ctypes.

This package and `header` import only the standard library, because an FMU can contain them. A library is loaded once
for each path. Threads may share a `LoadedSystem`; only one at a time may use an `instance.Instance`. Names and units:
`include/ali3.h`.
"""

from ..header.enumerations import Status
from ..header.limits import FARTHEST, FASTEST, OPEN
from ..header.structures import ControlFields, Sizes
from .errors import KernelError, open_row
from .library import library_path, load_library
from .loaded_system import LoadedSystem

__all__ = [
    "FARTHEST",
    "FASTEST",
    "OPEN",
    "ControlFields",
    "KernelError",
    "LoadedSystem",
    "Sizes",
    "Status",
    "library_path",
    "load_library",
    "open_row",
]
