"""Instances of one System that advance together."""

from collections.abc import Sequence
from ctypes import byref, c_void_p
from typing import Any, NamedTuple

from ..header.structures import LaneFields
from .buffers import buffer, pointer
from .errors import KernelError, creation_error, status_text
from .instance import Instance
from .kernel_memory import KernelMemory
from .library import load_library
from .loaded_system import LoadedSystem


class RunEnd(NamedTuple):
    """How the run of one instance ended."""

    done: int
    """Number of accepted steps."""
    alone: int
    """Number of steps made without the other instances."""
    error: KernelError | None
    """Error that ended the run; None if it was complete."""


def widest_lanes() -> int:
    """Largest number of instances that this processor advances together: 2, 4 or 8."""
    return int(load_library().ali3_widest_lanes())


class Many(KernelMemory):
    """Memory to advance several instances of a System together, each in a lane.

    `width`: number of lanes, 2, 4 or 8, at most `widest_lanes`.
    """

    def __init__(self, system: LoadedSystem, width: int) -> None:
        self._handle: c_void_p | None = None  # for __del__ if the kernel refuses
        self.system, self.width = system, width
        self._library = system._library
        handle = c_void_p()
        if status := self._library.ali3_many_new(system._handle, width, byref(handle)):
            raise creation_error(self._library, status, "instances cannot be advanced together")
        self._handle = handle

    def __del__(self) -> None:
        if self._handle is not None:
            self._library.ali3_many_free(self._handle)
            self._handle = None

    def _check(self, status: int) -> None:
        if status:
            raise KernelError(status, status_text(self._library, status))

    @property
    def size(self) -> int:
        """Memory beside that of the instances, bytes."""
        return int(self._library.ali3_many_size(self.system._handle, self.width))

    def run(
        self, instances: Sequence[Instance], h: float, n: int, every: int, out: Sequence[Any], positions: Sequence[Any]
    ) -> list[RunEnd]:
        """Advance each instance by `n` steps of `h` s, with the same results as `Instance.run`.

        `instances`: at most `width`, with the same settings; `out`, `positions`: arguments of `Instance.run`, one for
        each instance. An instance that stops does not change the others.
        """
        sizes = self.system.sizes
        lanes = (LaneFields * len(instances))()
        buffers = []  # lanes have only pointers to them
        for lane, instance, values, rows in zip(lanes, instances, out, positions, strict=True):
            out_buffer = buffer(values, n // every * sizes.ns, "out", writable=True)
            position_buffer = buffer(rows, n // every * sizes.nq, "positions", writable=True)
            buffers.append((out_buffer, position_buffer))
            lane.instance = instance._handle
            lane.out = pointer(out_buffer)
            lane.positions = pointer(position_buffer)
        self._check(self._library.ali3_many_run(self._handle, len(lanes), lanes, h, n, every))
        return [
            RunEnd(lane.done, lane.alone, self._error(instance, lane.status))
            for lane, instance in zip(lanes, instances, strict=True)
        ]

    def _error(self, instance: Instance, status: int) -> KernelError | None:
        try:
            instance._check(status)
        except KernelError as error:
            return error
        return None
