"""Starts the car's process, notes its end and ends it."""

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
    """A process that drives an FMU, seen from the main process.

    `ended`: why it has ended unasked; None while it lives. Raises `HostError`: the FMU cannot be started;
    `FailedFmuError`: it has taken the process down; nothing is then left of it.
    """

    def __init__(self, order: Order) -> None:
        self.ended: HostError | None = None
        self._asked = self._started = False
        self._said: queue.SimpleQueue[HostError | None] = queue.SimpleQueue()
        self._process: Isolated[Order, None] = Isolated(
            run_car, None, str, files_of_drives(order.fmu, [order.start]), shared_files(order.memory)
        )
        self._life = threading.Thread(target=self._live, args=(order,), name="car watch", daemon=True)
        self._life.start()
        try:
            error = self._said.get(timeout=_START_SECONDS)
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
        """End it and what watches it, within about 2 s whatever it does; it must have been asked to before."""
        self._asked = True
        self._life.join(_PATIENCE[0])
        self._process.close()
        self._life.join(_PATIENCE[1])

    def _begun(self, word: str) -> None:
        self._started = True
        self._said.put(None)

    def _live(self, order: Order) -> None:
        """The life of the process; it says once that the FMU has started, and nothing more."""
        error: HostError
        try:
            end = self._process.do(order, self._begun)
        except UserError as fault:
            error = HostError(str(fault))
        else:
            how = end.how if isinstance(end, Lost) else "has ended"
            message = f"The car's process {how}; start the simulator again."
            error = FailedFmuError(message if self._started else f"{order.fmu} could not be started. {message}")
        if not self._asked:
            self.ended = error
        self._said.put(error)
