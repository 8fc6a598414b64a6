"""PythonFMU slave that passes every call to the slave in C.

The library of the FMU (`python_calls.c`) makes the slave in C. It gives its address and functions as the name of the
instance, the only text that PythonFMU hands over. Answers do not pass PythonFMU, which knows few of them and makes
fmi2Fatal of an exception: so nothing here raises on account of a host's mistake. States, derivatives, statuses and
logging need no Python.
"""

from __future__ import annotations

import sys
from ctypes import CFUNCTYPE, POINTER, Structure, c_bool, c_char_p, c_double, c_int32, c_size_t, c_uint32, c_void_p
from typing import Any

from .pythonfmu.fmi2slave import Fmi2Slave

_REFERENCES, _REALS, _WHOLES = POINTER(c_uint32), POINTER(c_double), POINTER(c_int32)


class _Link(Structure):
    """`python_link` of `python_calls.c`."""

    _fields_ = (
        ("slave", c_void_p),
        ("name", c_char_p),
        ("answer", c_int32),
        ("setup", CFUNCTYPE(c_int32, c_void_p, c_double, c_bool, c_double)),
        ("enter", CFUNCTYPE(c_int32, c_void_p)),
        ("exit", CFUNCTYPE(c_int32, c_void_p)),
        ("step", CFUNCTYPE(c_int32, c_void_p, c_double, c_double)),
        ("terminate", CFUNCTYPE(c_int32, c_void_p)),
        ("get", CFUNCTYPE(c_int32, c_void_p, _REFERENCES, c_size_t, _REALS)),
        ("set", CFUNCTYPE(c_int32, c_void_p, _REFERENCES, c_size_t, _REALS)),
        ("get_whole", CFUNCTYPE(c_int32, c_void_p, _REFERENCES, c_size_t, _WHOLES)),
        ("set_whole", CFUNCTYPE(c_int32, c_void_p, _REFERENCES, c_size_t, _WHOLES)),
    )


class Slave(Fmi2Slave):
    """One instance behind the calls of FMI 2.0 co-simulation that PythonFMU knows."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        # PythonFMU puts the resources before the host's own path at each instantiation and leaves them there.
        sys.path[:] = [place for place in sys.path if place != kwargs["resources"]]
        self._link = link = _Link.from_address(int(kwargs["instance_name"]))
        self.instance_name = link.name.decode(errors="replace")
        self._slave = link.slave
        # Bound once: a field that is a function is made again at every look.
        self._step, self._get, self._set = link.step, link.get, link.set
        # Hosts ask for the same variables again and again.
        self._asked: list[int] = []
        self._references = (c_uint32 * 0)()

    def setup_experiment(
        self, start_time: float, stop_time: float | None = None, tolerance: float | None = None
    ) -> None:
        """Start and stop time, s; the tolerance has no use, since the inner step is fixed."""
        has_stop_time = stop_time is not None
        self._link.answer = self._link.setup(
            self._slave, start_time, has_stop_time, stop_time if has_stop_time else 0.0
        )

    def enter_initialization_mode(self) -> None:
        """Start values may be set from now on."""
        self._link.answer = self._link.enter(self._slave)

    def exit_initialization_mode(self) -> None:
        """Find the initial state."""
        self._link.answer = self._link.exit(self._slave)

    def do_step(self, current_time: float, step_size: float) -> bool:
        """Advance to ``current_time + step_size`` (s) in equal inner steps, or not at all."""
        self._link.answer = self._step(self._slave, current_time, step_size)
        return True

    def terminate(self) -> None:
        """The end of the run."""
        self._link.answer = self._link.terminate(self._slave)

    def get_real(self, vrs: list[int]) -> list[float]:
        """Values of variables, whole ones too."""
        if vrs != self._asked:
            self._asked, self._references = list(vrs), (c_uint32 * len(vrs))(*vrs)
        values = (c_double * len(vrs))()
        self._link.answer = self._get(self._slave, self._references, len(vrs), values)
        return values[:]

    def set_real(self, vrs: list[int], values: list[float]) -> None:
        """Values of inputs and parameters."""
        n = len(vrs)
        self._link.answer = self._set(self._slave, (c_uint32 * n)(*vrs), n, (c_double * n)(*values))

    def get_integer(self, vrs: list[int]) -> list[int]:
        """Values of whole variables."""
        values = (c_int32 * len(vrs))()
        self._link.answer = self._link.get_whole(self._slave, (c_uint32 * len(vrs))(*vrs), len(vrs), values)
        return values[:]

    def set_integer(self, vrs: list[int], values: list[int]) -> None:
        """Values of whole inputs and parameters."""
        n = len(vrs)
        self._link.answer = self._link.set_whole(self._slave, (c_uint32 * n)(*vrs), n, (c_int32 * n)(*values))
