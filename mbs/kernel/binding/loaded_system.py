"""A System in the memory of the kernel."""

import ctypes
import os
from ctypes import byref, c_void_p

from ..header.structures import Sizes
from .errors import KernelError, creation_error
from .kernel_memory import KernelMemory
from .library import load_library


class LoadedSystem(KernelMemory):
    """A System in the memory of the kernel, immutable and shared by its instances.

    `sizes`: numbers of coordinates, rows, inputs, sensors and others; `state_size`, `snapshot_size`, `instance_size`:
    bytes of a saved state, of a snapshot and of an instance.
    """

    def __init__(self, data: bytes) -> None:
        self._handle: c_void_p | None = None
        self._code: ctypes.CDLL | None = None
        self._library = load_library()
        handle = c_void_p()
        message = ctypes.create_string_buffer(256)
        status = self._library.ali3_system_load(bytes(data), len(data), byref(handle), message, len(message))
        if status:
            reason = f"{message.value.decode(errors='replace')}." if message.value else ""
            raise creation_error(self._library, status, "the System file was refused", reason)
        self._handle = handle
        self.sizes: Sizes = self._library.ali3_system_sizes(handle)
        self.state_size: int = self._library.ali3_state_size(handle)
        self.snapshot_size: int = self._library.ali3_snapshot_size(handle)
        self.instance_size: int = self._library.ali3_instance_size(handle)

    @property
    def structure(self) -> int:
        """Hash of all data that code generated for this System depends on."""
        return int(self._library.ali3_system_structure(self._handle))

    @property
    def has_avx2(self) -> bool:
        """Whether the processor has AVX2."""
        return int(self._library.ali3_widest_lanes()) > 2

    @property
    def has_code(self) -> bool:
        """Whether generated code is attached."""
        return self._code is not None

    def attach(self, library: str | os.PathLike[str]) -> None:
        """Use the code of a library that was generated for this System; before the first instance is created.

        Raises `KernelError` if the code is for another System, kernel or processor; `OSError`: the library cannot be
        loaded.
        """
        message = ctypes.create_string_buffer(256)
        code = ctypes.CDLL(os.fspath(library))
        address = ctypes.addressof(ctypes.c_char.in_dll(code, "ali3_generated_code"))
        status = self._library.ali3_system_attach(self._handle, address, message, len(message))
        if status:
            raise KernelError(status, f"the generated code was refused: {message.value.decode(errors='replace')}.")
        self._code = code  # keeps the library loaded

    def __del__(self) -> None:
        if self._handle is not None:
            self._library.ali3_system_free(self._handle)
            self._handle = None
