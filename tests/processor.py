"""The floating-point control register of this thread: MXCSR, through the C library of x86-64 Linux."""

import ctypes
import functools
import struct

DEFAULT = 0x1F80
"""To the nearest, denormal numbers kept, no trap."""

ODD = {
    "down": DEFAULT | 0x2000,
    "up": DEFAULT | 0x4000,
    "to zero": DEFAULT | 0x6000,
    "results flushed to zero": DEFAULT | 0x8000,
    "denormal numbers are zero": DEFAULT | 0x40,
    "all three": DEFAULT | 0xA040,
    "traps on": DEFAULT & ~0x680,
}
FLAGS = {"invalid": 1, "denormal": 2, "division by zero": 4, "overflow": 8, "underflow": 16, "inexact": 32}
_ALL_FLAGS = 0x3F  # of MXCSR
_PLACE = 28  # offset of MXCSR in fenv_t
_BYTES = 32  # of fenv_t


@functools.cache
def mathematics() -> ctypes.CDLL:
    """The C library's part on numbers."""
    return ctypes.CDLL("libm.so.6")


def _environment() -> ctypes.Array[ctypes.c_char]:
    result = ctypes.create_string_buffer(_BYTES)
    assert mathematics().fegetenv(result) == 0
    return result


def _register() -> int:
    return int(struct.unpack_from("<I", _environment(), _PLACE)[0])


def _set_register(value: int) -> None:
    environment = _environment()
    struct.pack_into("<I", environment, _PLACE, value)
    assert mathematics().fesetenv(environment) == 0


def control() -> int:
    """The register without its flags."""
    return _register() & ~_ALL_FLAGS


def set_control(value: int) -> None:
    """Set the register; its flags stay."""
    _set_register(value | flags())


def flags() -> int:
    """Flags of exceptions that were raised since they were cleared."""
    return _register() & _ALL_FLAGS


def set_flags(value: int) -> None:
    """Set the flags; the control stays."""
    _set_register(control() | value)
