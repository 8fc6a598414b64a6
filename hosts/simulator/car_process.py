"""The process of the car, in which only the loop of its steps runs."""

import gc
import json
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from multiprocessing import resource_tracker
from pathlib import Path

from fmpy.fmi1 import FMICallException

from ali3.processes import received
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.fmu.fmu import StepRefusedError
from hosts.simulator.clock import Clock, make_clock
from hosts.simulator.driven_fmu import DrivenFmu, Notice
from hosts.simulator.notices import Notices
from hosts.simulator.priority import request_priority
from hosts.simulator.real_time_clock import RealTimeClock
from hosts.simulator.shared_values import LOST_MESSAGES, LOST_ROWS, RECORDING, STATE_HEAD, STOP, SharedValues, Sizes
from hosts.simulator.step_times import TimesRecord

COMMANDS = ("run", "pause", "step", "speed", "reset", "rewind", "upright", "restart")
_IDLE = 0.004  # s
_IDLE_UNPACED = 0.0005  # s
_WORST_PERIOD = 0.5  # s
_STATE_INTERVAL = 20.0  # s, simulated time between states of a recording


@dataclass(frozen=True)
class Order:
    """The task of the process."""

    fmu: Path
    start: Mapping[str, Value]
    step: float
    paced: bool
    priority: bool
    sizes: Sizes
    memory: str
    """Name of the shared memory."""


def run_car(order: Order, tell: Callable[[str], None]) -> None:
    """Drive the FMU until the main process sets the stop flag; the work of a process, see `ali3.isolated_processes`.

    `tell`: called once, with an empty text, when the FMU has started. Raises `HostError` if it cannot be started.
    """
    resource_tracker.register = lambda *_: None  # the main process owns the memory
    shared = SharedValues(order.sizes, order.memory)
    car = DrivenFmu(order.fmu, order.start, order.step)
    try:
        loop = Loop(order, car, shared, make_clock())
        tell("")
        loop.run()
    except Exception as error:
        traceback.print_exc()
        raise HostError(f"The car's process met an internal error ({type(error).__name__}: {error}).") from error
    finally:
        car.close()


class Loop:
    """The loop that takes commands, makes steps at their times and publishes values."""

    def __init__(self, order: Order, car: DrivenFmu, shared: SharedValues, clock: Clock) -> None:
        self._order, self._car, self._shared, self._clock = order, car, shared, clock
        self._times = TimesRecord(shared.times)
        self._pace = RealTimeClock(clock, order.step, self._times, order.paced)
        self._notices = Notices(car.names, clock, self._times)
        self._running = self._refused = self._resumes = self._active = False
        self._steps_to_do = 0
        self._requests = 0
        self._state_due = self._state_every = max(1, round(_STATE_INTERVAL / order.step))
        self._worst, self._worst_before, self._worst_since = 0.0, 0.0, clock.now()
        self._mark = clock.now()
        self._publish(row=True)

    def run(self) -> None:
        """Run until the stop flag is set."""
        if self._order.priority and self._order.paced:
            self._tell(Notice("priority", request_priority()))
        for notice in self._notices.of_step(self._car):
            self._tell(notice)
        gc.collect()
        gc.freeze()
        gc.disable()
        shared, pace, paced = self._shared, self._pace, self._order.paced
        self._mark = self._clock.now()
        while not shared.flags[STOP]:
            self._take_commands()
            if not (self._running or self._steps_to_do):
                self._idle()
            elif (paced or self._has_room()) and pace.wait():
                self._step()
            self._account_time()

    def _has_room(self) -> bool:
        """Whether a row fits; without deadlines the car waits for the recording, so that no row is lost."""
        if not self._shared.flags[RECORDING] or self._shared.rows.has_room():
            return True
        self._clock.sleep_until(self._clock.now() + _IDLE_UNPACED)
        return False

    def _idle(self) -> None:
        self._clock.sleep_until(self._clock.now() + (_IDLE if self._order.paced else _IDLE_UNPACED))

    def _account_time(self) -> None:
        """Add the elapsed wall time to that of running or paused."""
        now = self._clock.now()
        self._times.add("wall" if self._active else "paused", now - self._mark)
        self._mark, self._active = now, bool(self._running or self._steps_to_do)

    def _step(self) -> None:
        car, wants = self._car, self._shared.wants
        if wants.written != self._requests:
            self._requests = wants.written
            car.inputs.want(wants.read())
        try:
            car.advance()
        except StepRefusedError as error:
            self._report_refusal(error)
            return
        if self._steps_to_do and not self._running:
            self._steps_to_do -= 1
        self._record_row()
        message = self._pace.done()
        if message:
            self._tell(Notice("behind", message))
        for notice in self._notices.of_step(car):
            self._tell(notice)
        self._publish()

    def _report_refusal(self, error: StepRefusedError) -> None:
        self._resumes, self._running, self._steps_to_do, self._refused = self._running, False, 0, True
        text = f"The FMU refused the step at {self._car.time:.3f} s: {error} The car is paused in the state before it."
        self._tell(Notice("refused", text, {"inputs": self._car.refused_inputs}))
        self._car.messages()
        self._publish()

    def _take_commands(self) -> None:
        commands = self._shared.commands.take()
        for code, value, request in commands.tolist():
            try:
                self._execute(COMMANDS[int(code)], value, request)
            except (HostError, StepRefusedError, FMICallException) as error:
                self._tell(Notice("told", str(error)))
                self._car.messages()
            self._publish()

    def _execute(self, name: str, value: float, request: float) -> None:
        car = self._car
        if name == "run" or name == "step":
            if self._refused:
                raise HostError(
                    f"The step at {car.time:.3f} s was refused; continue with rewind, reset or upright, "
                    f"not with {name}."
                )
            if not (self._running or self._steps_to_do):
                self._pace.restart()
            self._running, self._steps_to_do = name == "run", self._steps_to_do + int(value) if name == "step" else 0
        elif name == "pause":
            self._running, self._resumes, self._steps_to_do = False, False, 0
        elif name == "speed":
            self._pace.speed = value
        else:
            epoch = car.epoch
            try:
                self._jump(name, value, request)
            finally:
                self._pace.restart()
                if car.epoch != epoch:
                    self._notices.jumped(car)
                    self._publish(row=True)

    def _jump(self, name: str, value: float, request: float) -> None:
        car = self._car
        if name == "reset":
            notice = car.reset(request)
        elif name == "upright":
            notice = car.upright(request)
        elif name == "restart":
            notice = car.restart(received(), request)  # the values do not fit into the shared memory
        else:
            notice = car.rewind(value)
        if self._refused:
            self._running, self._resumes, self._refused = self._resumes, False, False
        self._steps_to_do = 0
        self._tell(notice)

    def _record_row(self) -> None:
        """Pass a row to the recording; without room it is counted as lost, and the loop does not wait."""
        shared, car = self._shared, self._car
        if not shared.flags[RECORDING]:
            return
        if not shared.rows.has_room():
            shared.flags[LOST_ROWS] += 1
            return
        row = shared.rows.slot()
        row[0], row[1], row[2] = car.count, car.time, car.epoch
        row[3:] = car.values
        shared.rows.finish()
        if car.count >= self._state_due:
            self._state_due = car.count + self._state_every
            state = car.state_bytes()
            if state:  # without room, a later state replaces it
                shared.states.put(STATE_HEAD.pack(car.count, car.epoch) + state)

    def _tell(self, notice: Notice) -> None:
        car = self._car
        record = {
            "time": car.time,
            "epoch": car.epoch,
            "kind": notice.kind,
            "text": notice.text,
            "details": notice.details,
        }
        if not self._shared.messages.put(json.dumps(record).encode()):
            self._shared.flags[LOST_MESSAGES] += 1

    def _publish(self, row: bool = False) -> None:
        """Publish the state for the main process. `row`: whether to record it first."""
        if row:
            self._record_row()
        car, pace, now = self._car, self._pace, self._clock.now()
        if now - self._worst_since > _WORST_PERIOD:
            self._worst_before, self._worst, self._worst_since = self._worst, 0.0, now
        self._worst = max(self._worst, pace.cost)
        slot = self._shared.moments.begin()
        slot[:13] = (
            car.count,
            car.time,
            car.epoch,
            self._running,
            self._refused,
            pace.behind,
            pace.speed,
            now,
            pace.cost,
            max(self._worst, self._worst_before),
            pace.lateness,
            self._times["missed"],
            car.saved,
        )
        slot[13:] = car.values
        self._shared.moments.finish()
