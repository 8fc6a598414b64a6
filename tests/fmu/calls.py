"""What tests call an FMU with: statuses, types, and an instance of FMI 3.0 with the calls of FMI 2.0."""

from collections.abc import Callable, Sequence
from ctypes import byref, c_bool, c_double
from typing import Any

from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import FMU3Slave

OK, WARNING, DISCARD, ERROR = range(4)
"""Statuses; FMPy itself makes one of the first two."""

HostMaker = Callable[..., Any]
"""Of the fixture `host`."""


class Slave3(FMU3Slave):  # type: ignore[misc]
    """FMPy's class with the names of that of FMI 2.0, for what both standards have.

    `sizes`: numbers of values by reference; `status`, `end`, `last`: of the last step, its status, whether it wished
    the end, and the last successful time.
    """

    def __init__(self, sizes: dict[int, int], **more: Any) -> None:
        super().__init__(**more)
        self.sizes = sizes
        self._experiment: tuple[float | None, float, float | None] = (None, 0.0, None)
        self.status, self.end, self.last = OK, False, 0.0
        self.getInteger, self.setInteger = self.getInt32, self.setInt32
        self.getFMUstate, self.setFMUstate, self.freeFMUstate = self.getFMUState, self.setFMUState, self.freeFMUState
        self.serializeFMUstate, self.deSerializeFMUstate = self.serializeFMUState, self.deserializeFMUState

    def setupExperiment(
        self, tolerance: float | None = None, startTime: float = 0.0, stopTime: float | None = None
    ) -> None:
        self._experiment = (tolerance, startTime, stopTime)

    def enterInitializationMode(self) -> None:
        super().enterInitializationMode(*self._experiment)

    def getReal(self, references: Sequence[int]) -> list[float]:
        return list(self.getFloat64(references, sum(self.sizes.get(r, 1) for r in references)))

    def setReal(self, references: Sequence[int], values: Sequence[float]) -> None:
        self.setFloat64(references, values)

    def doStep(self, time: float, step: float) -> None:
        event, end, early, last = c_bool(), c_bool(), c_bool(), c_double()
        arguments = (c_double(time), c_double(step), c_bool(True), byref(event), byref(end), byref(early), byref(last))
        self.status = int(self.dll.fmi3DoStep(self.component, *arguments))
        self.end, self.last = end.value, last.value
        assert not event.value
        assert not early.value
        if self.status > WARNING:
            raise FMICallException("fmi3DoStep", self.status)
