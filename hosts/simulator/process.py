"""Starts the car's process, notes its end and ends it."""

from __future__ import annotations

import multiprocessing
import threading
from collections.abc import Mapping
from multiprocessing import connection

from ali3.children import how_ended
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.simulator.car_process import Order, run_car

_START_SECONDS = 300.0
_PATIENCE = (1.4, 0.4)


class Process:
    """A process that drives an FMU, seen from the main process.

    `ended`: why it has ended unasked, as one sentence; empty while it lives. Raises `HostError`: the FMU cannot be
    started; nothing is then left of the process.
    """

    def __init__(self, order: Order) -> None:
        self.ended = ""
        self._asked = False
        self._watcher = threading.Thread(target=self._watch, name="car watch", daemon=True)
        # Spawned on every system: a copy of this process would hold its threads' locks, sockets and memory.
        context = multiprocessing.get_context("spawn")
        self._link, there = context.Pipe()
        self._process = context.Process(target=run_car, args=(order, there), name="car", daemon=True)
        try:
            self._process.start()
            there.close()
            words = self._first_words(order)
            if words:
                raise HostError(words)
        except BaseException:
            self.close()
            raise
        self._watcher.start()

    @property
    def pid(self) -> int | None:
        return self._process.pid

    def send(self, start: Mapping[str, Value]) -> None:
        """New start values."""
        self._link.send(start)

    def close(self) -> None:
        """End it and what watches it, within about 2 s whatever it does; it must have been asked to before."""
        self._asked = True
        if self._process.pid is not None:
            for patience, harder in zip(_PATIENCE, (self._process.kill, None), strict=True):
                self._process.join(patience)
                if self._process.exitcode is not None:
                    break
                if harder is not None:
                    harder()
        # It reads the link, which may close only after it.
        if self._watcher.ident is not None:
            self._watcher.join(_PATIENCE[1])
        self._link.close()

    def _first_words(self, order: Order) -> str:
        """Empty once the FMU has started, else why it has not."""
        if not connection.wait([self._link, self._process.sentinel], _START_SECONDS):
            raise HostError(f"{order.fmu} was not started within {_START_SECONDS:g} s.")
        try:
            return str(self._link.recv())
        except EOFError:
            raise HostError(f"{order.fmu} could not be started: {self._end()}") from None

    def _watch(self) -> None:
        connection.wait([self._process.sentinel])
        if self._asked:
            return
        try:
            words = str(self._link.recv()) if self._link.poll() else ""
        except (EOFError, OSError):
            words = ""
        text = words or self._end()
        self.ended = text[0].upper() + text[1:]

    def _end(self) -> str:
        self._process.join(1.0)
        return f"the car's process {how_ended(self._process.exitcode)}; start the simulator again."
