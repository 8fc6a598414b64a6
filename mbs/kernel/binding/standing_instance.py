"""Kernel instance without steps: settings, parameters, start, sensors and report."""

import math
from ctypes import byref, c_double, c_void_p
from typing import Any

from ..header.limits import OPEN
from ..header.structures import ReportFields
from .errors import KernelError, creation_error, status_text
from .kernel_memory import KernelMemory
from .loaded_system import LoadedSystem


class StandingInstance(KernelMemory):
    """State of a System without steps. A refused call keeps the last accepted state.

    `system`: kept alive by the instance.
    """

    def __init__(self, system: LoadedSystem) -> None:
        self._handle: c_void_p | None = None
        self.system = system
        self._library = system._library
        handle = c_void_p()
        if status := self._library.ali3_instance_new(system._handle, byref(handle)):
            raise creation_error(self._library, status, "the instance cannot be made")
        self._handle = handle
        # bound once, because an attribute of the library takes longer than a small step
        self._sensors = self._library.ali3_sensors

    def __del__(self) -> None:
        if self._handle is not None:
            self._library.ali3_instance_free(self._handle)
            self._handle = None

    def _check(self, status: int) -> None:
        if status:
            raise KernelError(status, status_text(self._library, status))

    def set_parameter(self, index: int, value: float) -> None:
        """Set a parameter; refused outside its range, and after the start if the parameter is fixed."""
        self._check(self._library.ali3_set_parameter(self._handle, index, value))

    def initialise(self, t0: float = 0.0) -> None:
        """Solve position and velocity problem, accelerations and multipliers of a start at time `t0`, s."""
        self._start(self._library.ali3_initialise(self._handle, t0))

    def static_equilibrium(self, t0: float = 0.0, tolerance: float = 1e-6, max_iterations: int = 200) -> None:
        """Find an equilibrium near the present position and set rates to zero.

        `t0`: time, s; `tolerance`: largest unbalanced force, N or N m.
        """
        self._start(self._library.ali3_static_equilibrium(self._handle, t0, tolerance, max_iterations))

    def _start(self, status: int) -> None:
        if not status:
            return
        report = self.report()
        text = status_text(self._library, status)
        if OPEN < report["violation"] < math.inf:
            text = f"{text[:-1]} (row {report['worst_row']} is open by {report['violation']:.3g} m)."
        raise KernelError(status, text)

    def sensors(self) -> Any:
        """Sensor values (ns,) at the present state, in a new C array."""
        values = (c_double * self.system.sizes.ns)()
        status = self._sensors(self._handle, values)
        if status:
            self._check(status)
        return values

    def report(self) -> dict[str, float | int]:
        """Counters and residuals by field name."""
        fields = self._report()
        return {name: getattr(fields, name) for name, _ in ReportFields._fields_}

    def _report(self) -> ReportFields:
        fields = ReportFields()
        self._check(self._library.ali3_report_get(self._handle, byref(fields)))
        return fields

    def get_state(self) -> tuple[Any, Any, Any, Any, Any]:
        """Copies of q, qd, qdd (nq,), multipliers of the rows (nc,) and states of the elements y (ny,)."""
        sizes = self.system.sizes
        arrays = tuple((c_double * n)() for n in (sizes.nq, sizes.nq, sizes.nq, sizes.nc, sizes.ny))
        self._check(self._library.ali3_get_state(self._handle, *arrays))
        return arrays[0], arrays[1], arrays[2], arrays[3], arrays[4]
