"""One drive of a soak test: runs of some seconds, one after the other in one instance of the FMU."""

import random
import time as clock
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from hosts.common.numbers import Value
from hosts.driving.pilots.pilot import OBSERVED
from hosts.driving.random_driver import RandomDriver, random_start
from hosts.fmu.fmu import Fmu, StepRefusedError
from hosts.soak.checks import LARGEST_BALANCE, BadStepError, Counts, Watch
from hosts.soak.last_seconds import RecentSteps
from hosts.soak.memory import Memory
from hosts.soak.soak_roads import Ground

_RUN = (15.0, 60.0)  # s, shortest and longest run
_LYING = 1.0  # s that an overturned car lies still before it is set upright
_STILL = 1.0  # m/s
_AGAIN = 100  # steps that are repeated from a saved state
_MOST_SAVED = 5  # failing stretches of a drive that are written
_PLACE = ("chassis.x", "chassis.y", "chassis.yaw")
_TOLD = 5.0  # s simulated between lines of progress


@dataclass(frozen=True)
class Task:
    """The settings of a drive."""

    fmu: str
    seed: int
    fidelity: int | None
    """None: the FMU has no choice."""
    seconds: float
    step: float
    """Communication step, s."""
    start: dict[str, Value]
    """Set before every start, over those of the seed."""
    grounds: tuple[Ground, ...]
    """Roads, of which one is drawn for each run; none: that of the FMU as it is."""
    out: str
    """Folder for failing stretches."""
    largest_balance: float = LARGEST_BALANCE


@dataclass
class Failure:
    """A failing stretch."""

    kind: str
    text: str
    run: int
    """Of the drive, from 0."""
    time: float
    """In the run, s."""
    road: str
    manoeuvre: str = ""
    """File for ``ali3 run``; empty where it was not written."""


@dataclass
class Outcome:
    """The result of a drive."""

    seed: int
    fidelity: int | None
    simulated: float = 0.0
    wall: float = 0.0
    """`simulated`, `wall`: s."""
    runs: int = 0
    uprights: int = 0
    rewinds: int = 0
    counts: Counts = field(default_factory=Counts)
    failures: list[Failure] = field(default_factory=list)
    messages: dict[str, int] = field(default_factory=dict)
    """What the FMU logged, and how often."""
    memory_last: float = 0.0
    memory_growth: float = 0.0
    """`memory_last`, `memory_growth`: MB: of the process at the end of the drive, and its growth since a quarter."""


class _Drive:
    """The instance with what is kept between its runs."""

    def __init__(self, task: Task, fmu: Fmu, tell: Callable[[float], None]) -> None:
        self.task, self.fmu, self._tell = task, fmu, tell
        self.inputs, self.outputs = fmu.names("input"), fmu.names("output")
        self.set, self.get = fmu.setter(self.inputs), fmu.getter(self.outputs)
        self.watch = Watch(self.outputs, task.step, task.largest_balance)
        self.recent = RecentSteps(fmu, [*self.inputs, *self.outputs], self.inputs, task.step)
        self.memory = Memory()
        self.outcome = Outcome(task.seed, task.fidelity, counts=self.watch.counts)
        self.grounds = task.grounds or (Ground("", ()),)
        self.observation = [(name, self.outputs.index(name)) for name in OBSERVED if name in self.outputs]
        self.rest = fmu.start_values(self.inputs).tolist()
        self.settable = {n for n, v in fmu.variables.items() if v.causality in ("parameter", "input")}
        self._started = False
        self._told = 0.0

    def start(self, values: Mapping[str, Value]) -> list[float]:
        """A new start of the FMU; outputs after it."""
        if self._started:
            self.fmu.reset()
        self._started = True
        start = {name: value for name, value in values.items() if name in self.settable}
        self.fmu.initialise(start)
        row = self.get()
        self.watch.begin(row)
        self.recent.begin(start, 0.0, [*self.rest, *row])
        return row

    def run(self) -> None:
        """A run from a random start until its end or a failure."""
        task, number = self.task, self.outcome.runs
        self.outcome.runs += 1
        seed = 100_000 * task.seed + number
        chance = random.Random(f"run {seed}")
        ground = self.grounds[int(chance.random() * len(self.grounds))]
        seconds = _RUN[0] + (_RUN[1] - _RUN[0]) * chance.random()
        steps = round(min(seconds, task.seconds - self.outcome.simulated) / task.step)
        again = 1 + int(chance.random() * (steps - _AGAIN - 1))
        start: dict[str, Value] = {**random_start(seed, ground.targets)}
        if ground.road:
            start["road.file"] = ground.road
        if task.fidelity is not None:
            start["fidelity"] = task.fidelity
        driver = RandomDriver(seed, self.inputs, ground.targets)
        try:
            self._steps(driver, start | task.start, max(steps, 1), again if steps > 2 * _AGAIN else 0)
        except (BadStepError, StepRefusedError) as error:
            self._failed(error, number, ground.road)
        for message in self.fmu.messages:
            self.outcome.messages[message] = self.outcome.messages.get(message, 0) + 1
        self.fmu.messages.clear()

    def _steps(self, driver: RandomDriver, start: dict[str, Value], steps: int, again: int) -> None:
        """Drive; a car that lies on its roof is set upright where it is."""
        h = self.task.step
        row = self.start(start)
        self._count, lying = 0, 0
        k = 0
        while k < steps:
            inputs = driver.act(k * h, {name: row[j] for name, j in self.observation})
            row = self._step([inputs.get(name, rest) for name, rest in zip(self.inputs, self.rest, strict=True)])
            k += 1
            if k == again:
                row = self._repeated(row)
                k += _AGAIN
            lying = lying + 1 if self.watch.overturned and self._still(row) else 0
            if lying * h > _LYING:
                row = self.start(start | self._upright(row))
                self.outcome.uprights += 1
                self._count, lying = 0, 0

    def _step(self, inputs: list[float]) -> list[float]:
        """A step with its checks; outputs after it."""
        h = self.task.step
        self._tried = inputs
        self.set(inputs)
        self.fmu.step(self._count * h, h)
        self._count += 1
        row = self.get()
        self.recent.add(self._count * h, [*inputs, *row])
        self.watch.step(row)
        self.outcome.simulated += h
        if self.outcome.simulated - self._told >= _TOLD:
            self._told = self.outcome.simulated
            self.memory.sample()
            self._tell(self._told)
        return row

    def _repeated(self, row: list[float]) -> list[float]:
        """Save the state, drive on, restore it and drive the same again: outputs must be the same bits."""
        state, count = self.fmu.state(), self._count
        try:
            first = [row := self._step(self._tried) for _ in range(_AGAIN)]
            self.fmu.restore(state)
        finally:
            self.fmu.free(state)
        for k, before in enumerate(first):
            self.fmu.step((count + k) * self.task.step, self.task.step)
            if self.get() != before:
                raise BadStepError("restored", f"{k + 1} steps after a state was restored the outputs are others.")
        self.outcome.rewinds += 1
        return row

    def _still(self, row: Sequence[float]) -> bool:
        return all(row[j] < _STILL for name, j in self.observation if name == "speed")

    def _upright(self, row: Sequence[float]) -> dict[str, Value]:
        """Start values on the wheels where the car is."""
        x, y, yaw = (row[self.outputs.index(name)] for name in _PLACE)
        return {"initial.x": x, "initial.y": y, "initial.z": 0.0, "initial.yaw": yaw, "initial.speed": 0.0}

    def _failed(self, error: BadStepError | StepRefusedError, number: int, road: str) -> None:
        kind, refused = (error.kind, None) if isinstance(error, BadStepError) else ("refused", self._tried)
        failure = Failure(kind, str(error), number, self._count * self.task.step, road)
        if len(self.outcome.failures) < _MOST_SAVED:
            name = f"seed_{self.task.seed}_fidelity_{self.task.fidelity or 0}_run_{number}"
            folder = Path(self.task.out) / "failures" / name
            failure.manoeuvre = str(self.recent.save(folder, kind, str(error), self.task.seed, refused))
        self.outcome.failures.append(failure)


def drive(task: Task, tell: Callable[[float], None] = lambda seconds: None) -> Outcome:
    """Drive a task. `tell`: hears the simulated seconds that are done.

    Raises `HostError`: the FMU cannot be started with what is set.
    """
    begin = clock.perf_counter()
    with Fmu(Path(task.fmu)) as fmu:
        driven = _Drive(task, fmu, tell)
        while driven.outcome.simulated < task.seconds - 0.5 * task.step:
            before = driven.outcome.simulated
            driven.run()
            if driven.outcome.simulated == before:  # a start whose first step fails gets no second
                driven.outcome.simulated += task.step
    outcome = driven.outcome
    outcome.wall = clock.perf_counter() - begin
    _, outcome.memory_last, outcome.memory_growth = driven.memory.growth()
    return outcome
