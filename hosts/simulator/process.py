"""Starts, watches and ends the process of the car."""

import queue
import threading
from collections.abc import Mapping
from pathlib import Path

from ali3.errors import UserError
from ali3.isolated_processes import Isolated, Lost
from hosts.common.errors import FailedFmuError, HostError
from hosts.common.numbers import Value
from hosts.fmu.own_process import files_of_drives
from hosts.simulator.car_process import Order, run_car
from hosts.simulator.shared_values import shared_files

_START_SECONDS = 300.0
_PATIENCE = (1.4, 0.4)


class Process:
    """The process that drives an FMU, as an object of the main process.

    `ended`: the reason why it has ended unexpectedly, or None. Raises `HostError` if the FMU cannot be started,
    `FailedFmuError` if the FMU has crashed the process.
    """

    def __init__(self, order: Order) -> None:
        self.ended: HostError | None = None
        self._stop_requested = self._started = False
        self._outcome: queue.SimpleQueue[HostError | None] = queue.SimpleQueue()
        self._process: Isolated[Order, None] = Isolated(
            run_car, None, str, files_of_drives(order.fmu, [order.start]), shared_files(order.memory)
        )
        self._watcher = threading.Thread(target=self._watch, args=(order,), name="car watch", daemon=True)
        self._watcher.start()
        try:
            error = self._outcome.get(timeout=_START_SECONDS)
        except queue.Empty:
            error = FailedFmuError(f"{order.fmu} was not started within {_START_SECONDS:g} s.")
        except BaseException:
            self.close()
            raise
        if error is not None:
            self.close()
            raise error

    @property
    def pid(self) -> int | None:
        return self._process.pid

    @property
    def folder(self) -> Path | None:
        """Temporary folder of the process, removed with it."""
        return self._process.folder

    def send(self, start: Mapping[str, Value]) -> None:
        """Send new start values to the process."""
        self._process.send(dict(start))

    def close(self) -> None:
        """End the process and its watching thread within about 2 s; the stop flag must have been set."""
        self._stop_requested = True
        self._watcher.join(_PATIENCE[0])
        self._process.close()
        self._watcher.join(_PATIENCE[1])

    def _report_start(self, word: str) -> None:
        self._started = True
        self._outcome.put(None)

    def _watch(self, order: Order) -> None:
        """Run the process to its end, in the watching thread."""
        error: HostError
        try:
            end = self._process.do(order, self._report_start)
        except UserError as fault:
            error = HostError(str(fault))
        else:
            how = end.how if isinstance(end, Lost) else "has ended"
            message = f"The car's process {how}; start the simulator again."
            error = FailedFmuError(message if self._started else f"{order.fmu} could not be started. {message}")
        if not self._stop_requested:
            self.ended = error
        self._outcome.put(error)
