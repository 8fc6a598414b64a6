"""A System in the kernel's memory."""

from __future__ import annotations

import ctypes
from ctypes import byref, c_void_p

from ..header.structures import Sizes
from .errors import refused_new
from .kernel_memory import KernelMemory
from .library import load_library


class LoadedSystem(KernelMemory):
    """A System in the kernel's memory, immutable and shared by its instances.

    `sizes`: numbers of coordinates, rows, inputs, sensors and so on; `state_size`, `snapshot_size`, `instance_size`:
    bytes of a saved state and of an instance.
    """

    def __init__(self, data: bytes) -> None:
        self._handle: c_void_p | None = None
        self._library = load_library()
        handle = c_void_p()
        message = ctypes.create_string_buffer(256)
        status = self._library.ali3_system_load(bytes(data), len(data), byref(handle), message, len(message))
        if status:
            reason = f"{message.value.decode(errors='replace')}." if message.value else ""
            raise refused_new(self._library, status, "the System file was refused", reason)
        self._handle = handle
        self.sizes: Sizes = self._library.ali3_system_sizes(handle)
        self.state_size: int = self._library.ali3_state_size(handle)
        self.snapshot_size: int = self._library.ali3_snapshot_size(handle)
        self.instance_size: int = self._library.ali3_instance_size(handle)

    def __del__(self) -> None:
        if self._handle is not None:
            self._library.ali3_system_free(self._handle)
            self._handle = None
