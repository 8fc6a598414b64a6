"""The kernel through ctypes. This package and `header` need nothing but the standard library, so that an FMU can
carry them.

A library is loaded once per path; a `LoadedSystem` may be shared by threads, an `instance.Instance` belongs to one
at a time. Names and units: `include/ali3.h`.
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
