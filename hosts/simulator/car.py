"""The car in the main process: sends inputs and commands to its process and reads its state without waiting."""

import math
import threading
from collections.abc import Callable, Mapping

import numpy as np

from hosts.common.closable import Closable
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.fmu.fmu import described
from hosts.fmu.scalars import constants_of
from hosts.fmu.steering_ratios import steering_as_set
from hosts.fmu.variables import Variables
from hosts.recordings.recording import Recorder, recorded_columns, recording_meta
from hosts.simulator.car_events import CarSettings, CarState, Event
from hosts.simulator.car_process import COMMANDS, Order
from hosts.simulator.process import Process
from hosts.simulator.process_messages import ProcessMessages, Records
from hosts.simulator.shared_values import RECORDING, ROW, STOP, SharedValues, Sizes
from hosts.simulator.step_times import StepTimes

__all__ = ["Car", "CarSettings", "CarState", "Event", "StepTimes"]

MIN_SPEED = 0.05
"""Least speed of slow motion, simulated over wall time."""
_ROW_SECONDS = 8.0
_MIN_ROWS = 2000
_MAX_ROW_BYTES = 1 << 24


class Car(Closable):
    """An FMU that runs in its own process; it begins paused, at time 0.

    `names`: numeric inputs, then numeric outputs; `units`: units by name; `step`: communication step, s. Raises
    `HostError` if the FMU cannot be started. Every method raises it after the process has ended unexpectedly.
    """

    def __init__(self, settings: CarSettings) -> None:
        self._settings, self.step = settings, settings.step
        description = described(settings.fmu)
        table = Variables(description)
        start = {n: table.settable(n, "start values").check(v, "start values") for n, v in settings.start.items()}
        if not (math.isfinite(settings.step) and settings.step > 0.0):
            raise HostError(f"The communication step is {settings.step:g} s; it must be positive.")
        variables = {v.name: v for v in description.modelVariables if v.type in ("Real", "Integer")}
        self.inputs = tuple(n for n, v in variables.items() if v.causality == "input")
        self.names = (*self.inputs, *(n for n, v in variables.items() if v.causality == "output"))
        if not self.names:
            raise HostError(f"{settings.fmu} has neither inputs nor outputs that are numbers: nothing could be driven.")
        self.units = {n: variables[n].unit or "1" for n in self.names}
        self.constants = constants_of(variables)
        self.constants |= steering_as_set(self.constants, table, start)
        self._table, self._ranges = table, [(table[n].low, table[n].high) for n in self.inputs]
        self._input_indices = {n: k for k, n in enumerate(self.inputs)}
        self._lock, self._request_count = threading.Lock(), 0
        self._requests = np.zeros(3 * len(self.inputs))
        self._closed = False
        rows = max(_MIN_ROWS, round(_ROW_SECONDS / settings.step)) if settings.record is not None else 1
        rows = min(rows, max(1, _MAX_ROW_BYTES // (8 * (len(ROW) + len(self.names)))))
        sizes = Sizes(len(self.inputs), len(self.names), rows)
        self._shared = SharedValues(sizes)
        self._shared.flags[RECORDING] = settings.record is not None
        self._process: Process | None = None
        self._messages: ProcessMessages | None = None
        try:
            timing = (settings.step, settings.paced, settings.priority)
            fmu = settings.fmu.absolute()
            self._process = Process(Order(fmu, start, *timing, sizes, self._shared.name))
            self._messages = ProcessMessages(self._shared, self._recorder(start))
        except BaseException:
            self.close()
            raise

    def _recorder(self, start: Mapping[str, Value]) -> Records | None:
        settings = self._settings
        if settings.record is None:
            return None
        outputs, interval = self.names[len(self.inputs) :], settings.interval
        every = recorded_columns(settings.fmu, self.inputs, outputs, settings.step, interval)
        meta = recording_meta(settings.fmu, settings.step, start, seed=settings.seed, world=settings.world)
        return Recorder(settings.record, self.names, self.units, meta, every=every)

    @property
    def ended(self) -> HostError | None:
        """The reason why the process ended unexpectedly; None if it did not."""
        return self._process.ended if self._process is not None else None

    def _check_alive(self) -> None:
        if self.ended is not None:
            raise self.ended
        if self._closed:
            raise HostError("The car is closed.")

    def want(self, values: Mapping[str, tuple[float, float]]) -> None:
        """Request values of inputs.

        `values`: for each input its value, which is limited to the range of the model description, and its largest
        change per second of simulated time; integers always change at once, as with an infinite rate. Raises
        `HostError` if an input does not exist or a number cannot be used; then no input changes.
        """
        checked = []
        for name, (value, rate) in values.items():
            index = self._input_indices.get(name)
            if index is None:
                raise HostError(f"The FMU has no input '{name}'; it has: {', '.join(self.inputs) or 'none'}.")
            if not math.isfinite(value):
                raise HostError(f"The input '{name}' is wanted to be {value}; only finite numbers can be used.")
            if not rate > 0.0:
                raise HostError(f"The input '{name}' is wanted to change by {rate} per second; it must be positive.")
            low, high = self._ranges[index]
            checked.append((index, min(max(value, low), high), rate))
        with self._lock:
            self._check_alive()
            for index, value, rate in checked:
                self._request_count += 1
                self._requests[3 * index : 3 * index + 3] = value, rate, self._request_count
            self._shared.wants.begin()[:] = self._requests
            self._shared.wants.finish()

    def command(self, name: str, value: float = 0.0) -> None:
        """Give a command to the car.

        `name`: ``run``, ``pause``, ``step`` (value: how many, at least 1; it pauses after them), ``speed`` (0.05 to 1,
        simulated over wall time), ``reset``, ``rewind`` (value: seconds of simulated time), ``upright``. Raises
        `HostError` if the command does not exist, or its value cannot be used.
        """
        commands = COMMANDS[:-1]
        if name not in commands:
            raise HostError(f"There is no command '{name}'; there are: {', '.join(commands)}.")
        if name == "step":
            value = value or 1.0
            if not (1.0 <= value <= 1e9 and value == int(value)):
                raise HostError(f"The number of steps is {value:g}; it must be a whole number of at least 1.")
        elif name == "speed" and not MIN_SPEED <= value <= 1.0:
            raise HostError(f"The speed is {value:g}; it must be from {MIN_SPEED:g} to 1.")
        elif name == "rewind" and not (math.isfinite(value) and value > 0.0):
            raise HostError(f"The time to rewind is {value:g} s; it must be positive.")
        with self._lock:
            self._send(name, value)

    def restart(self, changes: Mapping[str, Value]) -> None:
        """Start again at time 0 with other start values, which later resets keep.

        `changes`: parameters and start values that replace present ones. Raises `HostError` if a parameter or input
        does not exist, or cannot have this value.
        """
        checked = {n: self._table.settable(n, "start values").check(v, "start values") for n, v in changes.items()}
        with self._lock:
            self._send("restart", 0.0, checked)

    def _send(self, name: str, value: float, start: Mapping[str, Value] | None = None) -> None:
        self._check_alive()
        commands = self._shared.commands
        if not commands.has_room():
            raise HostError(f"The car has not yet carried out earlier commands; '{name}' was left out.")
        if start is not None and self._process is not None:
            self._process.send(start)
        commands.slot()[:] = COMMANDS.index(name), value, self._request_count
        commands.finish()

    def latest(self) -> CarState:
        """The newest state of the car, without waiting for its process."""
        with self._lock:
            self._check_alive()
            v = self._shared.moments.read()
        return CarState.of(v)

    def events(self) -> list[Event]:
        """Events since the last call."""
        events = self._messages.events() if self._messages is not None else []
        if not events and self.ended is not None:
            raise self.ended
        return events

    def step_times(self) -> StepTimes:
        """Times of the steps so far."""
        with self._lock:
            if not self._closed:
                self._last_times = StepTimes.of(self._shared.times, self.step, self._settings.paced)
        return self._last_times

    def close(self, progress: Callable[[float], object] = lambda fraction: None) -> None:
        """End the process within 2 s. `progress`: called with the finished fraction of a recording."""
        self.step_times()
        with self._lock:
            if self._closed:
                return
            self._closed = True
            self._shared.flags[STOP] = 1
        try:
            if self._process is not None:
                self._process.close()
            if self._messages is not None:
                self._messages.close(progress)
        finally:  # also if Ctrl-C interrupts the end of a recording
            self._shared.close()
