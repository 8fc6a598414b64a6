"""An FMU that is driven step by step, started again, set upright and rewound; it knows no clock."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.fmu.fmu import Fmu, StepRefusedError
from hosts.simulator.inputs import Inputs
from hosts.simulator.saved_states import Mark, SavedStates

_POSE = ("chassis.x", "chassis.y", "chassis.yaw")
_INITIAL = ("initial.x", "initial.y", "initial.yaw")
_SPEED = "initial.speed"
_MOVING = ("initial.lateral_speed", "initial.yaw_rate", "initial.settling")
_AT_REST = (*_INITIAL, _SPEED)


@dataclass(frozen=True)
class Notice:
    """A notice about a step, for the list of events."""

    kind: str
    text: str
    details: dict[str, Any] = field(default_factory=dict)
    """What a recording needs to repeat it."""


class DrivenFmu:
    """An instance of an FMU with its time, its inputs and its past.

    `start`: parameters and start values; `step`: communication step, s.

    Attributes
    ----------
    names : tuple of str
        Inputs, then outputs.
    values : ndarray of shape (len(names),)
        Inputs of the last step and outputs after it.
    count : int
        Steps that were made; repeating them in a rewind does not count.
    epoch : int
        One more with every jump.

    Raises
    ------
    HostError
        The FMU cannot be loaded or started.
    """

    def __init__(self, path: Path, start: Mapping[str, Value], step: float) -> None:
        self._fmu, self._step, self._start = Fmu(path), step, dict(start)
        self._closed = False
        self._past: SavedStates | None = None
        try:
            inputs, outputs = self._fmu.names("input"), self._fmu.names("output")
            self.names = (*inputs, *outputs)
            self.values = np.zeros(len(self.names))
            self._split = len(inputs)
            self._set, self._get = self._fmu.setter(inputs), self._fmu.reader(outputs)
            self.inputs = Inputs(self._held(inputs), [self._fmu.variables[n].type == "Integer" for n in inputs])
            can = bool(getattr(self._fmu.description.coSimulation, "canGetAndSetFMUstate", False))
            if can:
                self._past = SavedStates(self._fmu, len(inputs), step)
            self._poses = all(n in self.names for n in _POSE) and all(n in self._fmu.variables for n in _AT_REST)
            self._offset = (0.0, 0.0, 0.0)
            self.count = self.epoch = self._steps = 0
            self._begin = 0.0
            self._refused_inputs = self.inputs.values.copy()
            self._fmu.initialise(self._start)
            self._started()
            self._note_offset(self._start)
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Free the FMU; more than once does nothing."""
        if not self._closed:
            self._closed = True
            if self._past is not None:
                self._past.clear()
            self._fmu.close()

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return self._begin + self._steps * self._step

    @property
    def saved(self) -> float:
        """Simulated time that can be rewound, s."""
        return self._past.seconds if self._past is not None else 0.0

    @property
    def start(self) -> dict[str, Value]:
        """Start values of a reset."""
        return dict(self._start)

    def messages(self) -> list[str]:
        """What the FMU logged at warning or above since the last call."""
        messages = list(self._fmu.messages)
        self._fmu.messages.clear()
        return messages

    def advance(self) -> None:
        """Make a step; `StepRefusedError` with the FMU's sentence, and then all is as before it."""
        before = self.inputs.values.copy()
        self.inputs.advance(self._step)
        try:
            self._make_step()
        except StepRefusedError:
            self._refused_inputs = self.inputs.values.copy()
            self.inputs.values[:] = before
            raise
        self.count += 1
        if self._past is not None:
            self._past.add(self.inputs.values, self._mark())

    def state_bytes(self) -> bytes:
        """The state after the last step, for a file; empty where the FMU cannot write it."""
        try:
            return self._fmu.state_bytes()
        except HostError:
            return b""

    @property
    def refused_inputs(self) -> list[float]:
        """Inputs of the last step that was refused."""
        refused: list[float] = self._refused_inputs.tolist()
        return refused

    def _make_step(self) -> None:
        try:
            self._set(self.inputs.values.tolist())
        except HostError as error:
            raise StepRefusedError(str(error)) from None
        self._fmu.step(self.time, self._step)
        self._steps += 1
        self._read()

    def _read(self) -> None:
        self.values[: self._split] = self.inputs.values
        self._get(self.values[self._split :])

    def _mark(self) -> Mark:
        return Mark(self.count, self.epoch, self._begin, self._steps)

    def _held(self, names: Sequence[str]) -> list[float]:
        """Start values of inputs."""
        defaults = self._fmu.start_values(names)
        return [float(self._start.get(n, x)) for n, x in zip(names, defaults, strict=True)]

    def _started(self) -> None:
        self._read()
        if self._past is not None:
            self._past.begin(self.inputs.values, self._mark())

    def _note_offset(self, start: Mapping[str, Value]) -> None:
        """Where the point that the FMU reports lies from the origin that it places, in axes of the car."""
        if self._poses:
            defaults = self._fmu.start_values(_INITIAL)
            x, y, yaw = (float(start.get(n, v)) for n, v in zip(_INITIAL, defaults, strict=True))
            present = [float(self.values[self.names.index(n)]) for n in _POSE]
            dx, dy, cos, sin = present[0] - x, present[1] - y, math.cos(yaw), math.sin(yaw)
            self._offset = (dx * cos + dy * sin, dy * cos - dx * sin, present[2] - yaw)

    def _new_start(self, start: Mapping[str, Value], begin: float, request: float) -> None:
        """A new start of the FMU; if it is refused, the FMU is where it was."""
        before = self._fmu.state() if self._past is not None else None
        try:
            self._fmu.reset()
            self._fmu.initialise(start, begin)
        except HostError as error:
            self._fmu.reset()
            if before is None:
                self._fmu.initialise(self._start)
                self._begin, self._steps = 0.0, 0
                self.epoch += 1
                self._read()
                raise HostError(f"{error} The car starts again as at first: its FMU does not save states.") from None
            self._fmu.restore(before)
            raise
        finally:
            if before is not None:
                self._fmu.free(before)
        self._begin, self._steps = begin, 0
        self.epoch += 1
        self.inputs.restart(request)

    def reset(self, request: float) -> Notice:
        """Start again at time 0 as at first; wants up to the number `request` are forgotten."""
        self._new_start(self._start, 0.0, request)
        self._started()
        return Notice("reset", "The car starts again.", {"start": self.start})

    def restart(self, changes: Mapping[str, Value], request: float) -> Notice:
        """Start again at time 0 with other start values, which stay for later resets; `HostError` if refused."""
        changed = self._start | dict(changes)
        self._new_start(changed, 0.0, request)
        self._start = changed
        self.inputs.set_start(self._held(self.names[: self._split]))
        self.inputs.restart(request)
        self._started()
        self._note_offset(changed)
        return Notice("reset", f"The car starts again with {_words(changes)}.", {"start": self.start})

    def upright(self, request: float) -> Notice:
        """Start again where the car is, with its heading, at rest; time goes on."""
        if not self._poses:
            missing = [n for n in _POSE if n not in self.names] + [n for n in _AT_REST if n not in self._fmu.variables]
            raise HostError(
                f"The car cannot be set upright: {self._fmu.path.name} has no {missing[0]}; a reset starts it again."
            )
        x, y, yaw = (float(self.values[self.names.index(n)]) for n in _POSE)
        dx, dy, turn = self._offset
        heading = yaw - turn
        # The FMU places the origin of its drawing; what it tells is a point of the chassis.
        initial = (
            x - dx * math.cos(heading) + dy * math.sin(heading),
            y - dx * math.sin(heading) - dy * math.cos(heading),
            heading,
        )
        if not all(map(math.isfinite, initial)):
            raise HostError("The car cannot be set upright: its place is not a finite number; a reset starts it again.")
        start = self._start | dict(zip(_INITIAL, initial, strict=True)) | {_SPEED: 0.0}
        start |= {name: 0.0 for name in _MOVING if name in start}
        self._new_start(start, self.time, request)
        self._started()
        return Notice("upright", f"The car was set on its wheels at x = {x:.2f} m, y = {y:.2f} m.", {"start": start})

    def rewind(self, seconds: float) -> Notice:
        """Go back by so much simulated time, or as far as there are saved states."""
        if self._past is None:
            raise HostError(f"{self._fmu.path.name} cannot go back: it does not save its state (canGetAndSetFMUstate).")
        requested = round(seconds / self._step)
        steps = min(requested, self._past.steps)
        if not steps:
            raise HostError("There is nothing to go back to: no step was made since the oldest state that is kept.")
        self.epoch += 1
        mark, input_values, rows = self._past.back(steps)
        self._begin, self._steps = mark.begin, mark.steps
        for row in rows:
            self.inputs.values[:] = row
            self._make_step()
        self.inputs.values[:] = input_values
        self._read()
        less = f" ({seconds:g} s were asked for; no older state is kept)" if steps < requested else ""
        text = f"The car went back by {steps * self._step:g} s, to {self.time:.3f} s{less}."
        return Notice("rewind", text, {"back_to": mark.count, "back_to_epoch": mark.epoch})


def _words(changes: Mapping[str, Value]) -> str:
    return ", ".join(f"{n} = {v:g}" if isinstance(v, float) else f"{n} = {v}" for n, v in changes.items())
