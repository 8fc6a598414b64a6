"""One drive of a soak test: runs of some seconds, one after the other in one instance of the FMU, and its memory."""

import random
import time as clock
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median

import psutil

from hosts.common.numbers import Value
from hosts.driving.pilots.pilot import OBSERVED
from hosts.driving.random_driver import RandomDriver, random_start
from hosts.fmu.fmu import Fmu, StepRefusedError
from hosts.soak.checks import LARGEST_BALANCE, BadStepError, Counts, Watch
from hosts.soak.last_seconds import RecentSteps
from hosts.soak.soak_roads import Ground

_RUN_DURATIONS = (15.0, 60.0)  # s, shortest and longest run
_OVERTURNED_DURATION = 1.0  # s that an overturned car lies still before it is set upright
_STANDING_SPEED = 1.0  # m/s
_REPEATED_STEPS = 100  # steps that are repeated from a saved state
_MOST_STRETCHES = 5  # failing stretches of a drive that are written
_POSE = ("chassis.x", "chassis.y", "chassis.yaw")
_PROGRESS_INTERVAL = 5.0  # s simulated between lines of progress
LARGEST_GROWTH = 2.0
"""MB from a quarter of a drive to its end: Python's own varies by less, a leak of a state in each run is more."""


class Memory:
    """Samples of the resident memory."""

    def __init__(self) -> None:
        self._process = psutil.Process()
        self._samples: list[float] = []

    def sample(self) -> None:
        """Take a sample of the memory."""
        self._samples.append(1e-6 * self._process.memory_info().rss)

    def growth(self) -> tuple[float, float, float]:
        """Memory after the first quarter and at the end, and its growth, MB; medians of a tenth of the samples."""
        count = len(self._samples)
        if count < 8:
            return 0.0, 0.0, 0.0
        some = max(count // 10, 1)
        first, last = median(self._samples[count // 4 : count // 4 + some]), median(self._samples[-some:])
        return first, last, last - first


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
    """Set at every start, in place of those of the seed."""
    grounds: tuple[Ground, ...]
    """Roads, of which one is drawn for each run; empty: that of the FMU."""
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
    """Messages of the FMU with their numbers."""
    memory_last: float = 0.0
    memory_growth: float = 0.0
    """`memory_last`, `memory_growth`: of the process at the end of the drive, and growth since a quarter, MB."""


class _Drive:
    """The instance of the FMU and the data that its runs share."""

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
        self._reported_time = 0.0

    def start(self, values: Mapping[str, Value]) -> list[float]:
        """Start the FMU; returns the outputs."""
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
        task, run_number = self.task, self.outcome.runs
        self.outcome.runs += 1
        seed = 100_000 * task.seed + run_number
        generator = random.Random(f"run {seed}")
        ground = self.grounds[int(generator.random() * len(self.grounds))]
        seconds = _RUN_DURATIONS[0] + (_RUN_DURATIONS[1] - _RUN_DURATIONS[0]) * generator.random()
        steps = round(min(seconds, task.seconds - self.outcome.simulated) / task.step)
        repeated_from = 1 + int(generator.random() * (steps - _REPEATED_STEPS - 1))
        start: dict[str, Value] = {**random_start(seed, ground.targets)}
        if ground.road:
            start["road.file"] = ground.road
        if task.fidelity is not None:
            start["fidelity"] = task.fidelity
        driver = RandomDriver(seed, self.inputs, ground.targets)
        try:
            self._drive_steps(
                driver, start | task.start, max(steps, 1), repeated_from if steps > 2 * _REPEATED_STEPS else 0
            )
        except (BadStepError, StepRefusedError) as error:
            self._add_failure(error, run_number, ground.road)
        for message in self.fmu.messages:
            self.outcome.messages[message] = self.outcome.messages.get(message, 0) + 1
        self.fmu.messages.clear()

    def _drive_steps(self, driver: RandomDriver, start: dict[str, Value], steps: int, repeated_from: int) -> None:
        """Drive; an overturned car is set upright where it lies."""
        h = self.task.step
        row = self.start(start)
        self._steps_since_start, overturned_steps = 0, 0
        k = 0
        while k < steps:
            inputs = driver.act(k * h, {name: row[j] for name, j in self.observation})
            row = self._step([inputs.get(name, rest) for name, rest in zip(self.inputs, self.rest, strict=True)])
            k += 1
            if k == repeated_from:
                row = self._repeat_from_saved_state(row)
                k += _REPEATED_STEPS
            overturned_steps = overturned_steps + 1 if self.watch.overturned and self._still(row) else 0
            if overturned_steps * h > _OVERTURNED_DURATION:
                row = self.start(start | self._upright(row))
                self.outcome.uprights += 1
                self._steps_since_start, overturned_steps = 0, 0

    def _step(self, inputs: list[float]) -> list[float]:
        """Make a step and check it; returns the outputs."""
        h = self.task.step
        self._last_inputs = inputs
        self.set(inputs)
        self.fmu.step(self._steps_since_start * h, h)
        self._steps_since_start += 1
        row = self.get()
        self.recent.add(self._steps_since_start * h, [*inputs, *row])
        self.watch.step(row)
        self.outcome.simulated += h
        if self.outcome.simulated - self._reported_time >= _PROGRESS_INTERVAL:
            self._reported_time = self.outcome.simulated
            self.memory.sample()
            self._tell(self._reported_time)
        return row

    def _repeat_from_saved_state(self, row: list[float]) -> list[float]:
        """Save the state, drive on, restore it and drive the same again: outputs must be the same bits."""
        state, count = self.fmu.state(), self._steps_since_start
        try:
            first = [row := self._step(self._last_inputs) for _ in range(_REPEATED_STEPS)]
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
        return all(row[j] < _STANDING_SPEED for name, j in self.observation if name == "speed")

    def _upright(self, row: Sequence[float]) -> dict[str, Value]:
        """Start values that put the car on its wheels where it is."""
        x, y, yaw = (row[self.outputs.index(name)] for name in _POSE)
        return {"initial.x": x, "initial.y": y, "initial.z": 0.0, "initial.yaw": yaw, "initial.speed": 0.0}

    def _add_failure(self, error: BadStepError | StepRefusedError, run_number: int, road: str) -> None:
        kind, refused = (error.kind, None) if isinstance(error, BadStepError) else ("refused", self._last_inputs)
        failure = Failure(kind, str(error), run_number, self._steps_since_start * self.task.step, road)
        if len(self.outcome.failures) < _MOST_STRETCHES:
            name = f"seed_{self.task.seed}_fidelity_{self.task.fidelity or 0}_run_{run_number}"
            folder = Path(self.task.out) / "failures" / name
            failure.manoeuvre = str(self.recent.save(folder, kind, str(error), self.task.seed, refused))
        self.outcome.failures.append(failure)


def drive(task: Task, tell: Callable[[float], None] = lambda seconds: None) -> Outcome:
    """Drive a task. `tell`: called with the simulated seconds.

    Raises `HostError`: the FMU cannot be started with these values.
    """
    begin = clock.perf_counter()
    with Fmu(Path(task.fmu)) as fmu:
        car_drive = _Drive(task, fmu, tell)
        while car_drive.outcome.simulated < task.seconds - 0.5 * task.step:
            before = car_drive.outcome.simulated
            car_drive.run()
            if car_drive.outcome.simulated == before:  # a start whose first step fails is not repeated
                car_drive.outcome.simulated += task.step
    outcome = car_drive.outcome
    outcome.wall = clock.perf_counter() - begin
    _, outcome.memory_last, outcome.memory_growth = car_drive.memory.growth()
    return outcome
