"""An FMU driven step by step by rate-limited inputs, started again, set upright and rewound, without a clock."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.fmu.fmu import Fmu, StepRefusedError
from hosts.simulator.saved_states import Mark, SavedStates

_POSE = ("chassis.x", "chassis.y", "chassis.yaw")
_INITIAL = ("initial.x", "initial.y", "initial.yaw")
_SPEED = "initial.speed"
_INITIAL_MOTION = ("initial.lateral_speed", "initial.yaw_rate", "initial.settling")
_AT_REST = (*_INITIAL, _SPEED)


class Inputs:
    """Values of the inputs and their targets.

    `start`: values at every new start, n; `whole`: whether each is an integer, which changes at once. `values`: values
    of the last or next step, shape (n,).
    """

    def __init__(self, start: Sequence[float], whole: Sequence[bool]) -> None:
        self._start, self._whole = np.array(start, float), list(whole)
        self.values = self._start.copy()
        self._targets: list[float] = list(start)
        self._rates: list[float] = [0.0] * len(start)
        self._oldest_request = 0.0

    def want(self, wants: NDArray[np.float64]) -> None:
        """Set the requested values of inputs.

        `wants`: of each input its value, largest change per second (infinite: at once) and the number of the request,
        shape (3 n,); requests before the last `restart` are ignored.
        """
        for k in range(len(self._rates)):
            value, rate, request = wants[3 * k : 3 * k + 3].tolist()
            if request > self._oldest_request:
                self._targets[k] = float(round(value)) if self._whole[k] else value
                self._rates[k] = float("inf") if self._whole[k] else rate

    def restart(self, request: float) -> None:
        """Return to the start values; requests up to this number are ignored."""
        self.values[:] = self._start
        self._targets, self._rates = self._start.tolist(), [0.0] * len(self._rates)
        self._oldest_request = request

    def set_start(self, start: Sequence[float]) -> None:
        """Replace the start values."""
        self._start[:] = start

    def advance(self, step: float) -> None:
        """Move the values towards their targets by one step, s."""
        values = self.values
        for k, (target, rate) in enumerate(zip(self._targets, self._rates, strict=True)):
            value = float(values[k])
            if value != target:
                limit = rate * step
                values[k] = target if abs(target - value) <= limit else value + (limit if target > value else -limit)


@dataclass(frozen=True)
class Notice:
    """A notice about a step, for the list of events."""

    kind: str
    text: str
    details: dict[str, Any] = field(default_factory=dict)
    """Data with which a recording can repeat it."""


class DrivenFmu:
    """An instance of an FMU with its time, its inputs and its saved states.

    `start`: parameters and start values; `step`: communication step, s.

    Attributes
    ----------
    names : tuple of str
        Inputs, then outputs.
    values : ndarray of shape (len(names),)
        Inputs of the last step and outputs after it.
    count : int
        Steps made so far, without those repeated in a rewind.
    epoch : int
        Number of rewinds and new starts.

    Raises
    ------
    HostError
        The FMU cannot be loaded or started.
    """

    def __init__(self, path: Path, start: Mapping[str, Value], step: float) -> None:
        self._fmu, self._step, self._start = Fmu(path), step, dict(start)
        self._closed = False
        self._saved_states: SavedStates | None = None
        try:
            inputs, outputs = self._fmu.names("input"), self._fmu.names("output")
            self.names = (*inputs, *outputs)
            self.values = np.zeros(len(self.names))
            self._input_count = len(inputs)
            self._set, self._get = self._fmu.setter(inputs), self._fmu.reader(outputs)
            self.inputs = Inputs(self._start_inputs(inputs), [self._fmu.variables[n].type == "Integer" for n in inputs])
            has_states = bool(getattr(self._fmu.description.coSimulation, "canGetAndSetFMUstate", False))
            if has_states:
                self._saved_states = SavedStates(self._fmu, len(inputs), step)
            self._has_pose = all(n in self.names for n in _POSE) and all(n in self._fmu.variables for n in _AT_REST)
            self._offset = (0.0, 0.0, 0.0)
            self.count = self.epoch = self._steps = 0
            self._begin = 0.0
            self._refused_inputs = self.inputs.values.copy()
            self._fmu.initialise(self._start)
            self._after_start()
            self._store_offset(self._start)
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Free the FMU, once."""
        if not self._closed:
            self._closed = True
            if self._saved_states is not None:
                self._saved_states.clear()
            self._fmu.close()

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return self._begin + self._steps * self._step

    @property
    def saved(self) -> float:
        """Simulated time that can be rewound, s."""
        return self._saved_states.seconds if self._saved_states is not None else 0.0

    @property
    def start(self) -> dict[str, Value]:
        """Start values of a reset."""
        return dict(self._start)

    def messages(self) -> list[str]:
        """Messages of the FMU at warning or above since the last call."""
        messages = list(self._fmu.messages)
        self._fmu.messages.clear()
        return messages

    def advance(self) -> None:
        """Make a step. Raises `StepRefusedError` with the message of the FMU; then nothing has changed."""
        before = self.inputs.values.copy()
        self.inputs.advance(self._step)
        try:
            self._make_step()
        except StepRefusedError:
            self._refused_inputs = self.inputs.values.copy()
            self.inputs.values[:] = before
            raise
        self.count += 1
        if self._saved_states is not None:
            self._saved_states.add(self.inputs.values, self._mark())

    def state_bytes(self) -> bytes:
        """The state after the last step as bytes; empty if the FMU cannot serialize it."""
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
        self.values[: self._input_count] = self.inputs.values
        self._get(self.values[self._input_count :])

    def _mark(self) -> Mark:
        return Mark(self.count, self.epoch, self._begin, self._steps)

    def _start_inputs(self, names: Sequence[str]) -> list[float]:
        """Start values of inputs."""
        defaults = self._fmu.start_values(names)
        return [float(self._start.get(n, x)) for n, x in zip(names, defaults, strict=True)]

    def _after_start(self) -> None:
        self._read()
        if self._saved_states is not None:
            self._saved_states.begin(self.inputs.values, self._mark())

    def _store_offset(self, start: Mapping[str, Value]) -> None:
        """Store the position of the reported point relative to the placed origin, in axes of the car."""
        if self._has_pose:
            defaults = self._fmu.start_values(_INITIAL)
            x, y, yaw = (float(start.get(n, v)) for n, v in zip(_INITIAL, defaults, strict=True))
            present = [float(self.values[self.names.index(n)]) for n in _POSE]
            dx, dy, cos, sin = present[0] - x, present[1] - y, math.cos(yaw), math.sin(yaw)
            self._offset = (dx * cos + dy * sin, dy * cos - dx * sin, present[2] - yaw)

    def _start_again(self, start: Mapping[str, Value], begin: float, request: float) -> None:
        """Start the FMU again; if it refuses, it keeps its state."""
        before = self._fmu.state() if self._saved_states is not None else None
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
        """Start again at time 0 with the first start values; requests up to the number `request` are dropped."""
        self._start_again(self._start, 0.0, request)
        self._after_start()
        return Notice("reset", "The car starts again.", {"start": self.start})

    def restart(self, changes: Mapping[str, Value], request: float) -> Notice:
        """Start again at time 0 with other start values, kept for later resets; `HostError` if they are refused."""
        changed = self._start | dict(changes)
        self._start_again(changed, 0.0, request)
        self._start = changed
        self.inputs.set_start(self._start_inputs(self.names[: self._input_count]))
        self.inputs.restart(request)
        self._after_start()
        self._store_offset(changed)
        return Notice("reset", f"The car starts again with {_changes_text(changes)}.", {"start": self.start})

    def upright(self, request: float) -> Notice:
        """Start again at the present position and heading, at rest, without changing the time."""
        if not self._has_pose:
            missing = [n for n in _POSE if n not in self.names] + [n for n in _AT_REST if n not in self._fmu.variables]
            raise HostError(
                f"The car cannot be set upright: {self._fmu.path.name} has no {missing[0]}; a reset starts it again."
            )
        x, y, yaw = (float(self.values[self.names.index(n)]) for n in _POSE)
        dx, dy, turn = self._offset
        heading = yaw - turn
        # Start values place the origin of the drawing; outputs are of a point of the chassis.
        initial = (
            x - dx * math.cos(heading) + dy * math.sin(heading),
            y - dx * math.sin(heading) - dy * math.cos(heading),
            heading,
        )
        if not all(map(math.isfinite, initial)):
            raise HostError("The car cannot be set upright: its place is not a finite number; a reset starts it again.")
        start = self._start | dict(zip(_INITIAL, initial, strict=True)) | {_SPEED: 0.0}
        start |= {name: 0.0 for name in _INITIAL_MOTION if name in start}
        self._start_again(start, self.time, request)
        self._after_start()
        return Notice("upright", f"The car was set on its wheels at x = {x:.2f} m, y = {y:.2f} m.", {"start": start})

    def rewind(self, seconds: float) -> Notice:
        """Go back by a simulated time, s, or to the oldest saved state."""
        if self._saved_states is None:
            raise HostError(f"{self._fmu.path.name} cannot go back: it does not save its state (canGetAndSetFMUstate).")
        requested = round(seconds / self._step)
        steps = min(requested, self._saved_states.steps)
        if not steps:
            raise HostError("There is nothing to go back to: no step was made since the oldest state that is kept.")
        self.epoch += 1
        mark, input_values, rows = self._saved_states.back(steps)
        self._begin, self._steps = mark.begin, mark.steps
        for row in rows:
            self.inputs.values[:] = row
            self._make_step()
        self.inputs.values[:] = input_values
        self._read()
        less = f" ({seconds:g} s were asked for; no older state is kept)" if steps < requested else ""
        text = f"The car went back by {steps * self._step:g} s, to {self.time:.3f} s{less}."
        return Notice("rewind", text, {"back_to": mark.count, "back_to_epoch": mark.epoch})


def _changes_text(changes: Mapping[str, Value]) -> str:
    return ", ".join(f"{n} = {v:g}" if isinstance(v, float) else f"{n} = {v}" for n, v in changes.items())
