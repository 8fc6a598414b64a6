"""Saved states of the FMU and the inputs since, so that a drive can be rewound to any step of the last seconds."""

from collections import deque
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from hosts.fmu.instance import State

SECONDS = 30.0
EVERY = 0.5
# Each new start saves a state; more states shorten the time that can be rewound.
_MAX_STATES = 200
_MAX_BYTES = 1 << 26  # of the inputs; with many inputs or short steps it shortens that time too


class SavesStates(Protocol):
    """The interface of `hosts.fmu.fmu.Fmu` that is used here."""

    def state(self) -> State: ...
    def restore(self, state: State) -> None: ...
    def free(self, state: State) -> None: ...


@dataclass(frozen=True)
class Mark:
    """A past step, with the start of the FMU before it."""

    count: int
    """Count in the row of the step."""
    epoch: int
    """Epoch in the row of the step."""
    begin: float
    """Start time of the FMU, s."""
    steps: int
    """Steps since that start."""


@dataclass(frozen=True)
class _Saved:
    step_number: int
    state: State
    mark: Mark


class SavedStates:
    """States every half second of simulated time, for the last 30 s, and the inputs of every step since the oldest.

    `step`: communication step, s.
    """

    def __init__(self, fmu: SavesStates, inputs: int, step: float) -> None:
        self._fmu, self._step = fmu, step
        limit = _MAX_BYTES // (8 * inputs + 16)
        self._every = max(1, min(round(EVERY / step), limit // 8))
        self._length = max(1, min(round(SECONDS / step), limit))
        capacity = self._length + self._every + 1
        self._inputs = np.empty((capacity, inputs))
        self._marks: NDArray[np.int64] = np.empty((capacity, 2), np.int64)
        self._saved: deque[_Saved] = deque()
        self._step_number = 0

    @property
    def bytes(self) -> int:
        """Memory of the inputs, bytes."""
        return self._inputs.nbytes + self._marks.nbytes

    @property
    def seconds(self) -> float:
        """Simulated time that can be rewound, s."""
        return self._step * self.steps

    @property
    def steps(self) -> int:
        """Number of steps that can be rewound."""
        return self._step_number - self._saved[0].step_number if self._saved else 0

    def begin(self, inputs: NDArray[np.float64], mark: Mark) -> None:
        """Save the state of a new start, with the inputs held there."""
        self._store(inputs, mark)
        self._save(mark)

    def add(self, inputs: NDArray[np.float64], mark: Mark) -> None:
        """Store the inputs of a step that was made, and its state if one is due."""
        self._store(inputs, mark)
        if self._step_number - self._saved[-1].step_number >= self._every:
            self._save(mark)

    def _store(self, inputs: NDArray[np.float64], mark: Mark) -> None:
        self._step_number += 1
        k = self._step_number % len(self._inputs)
        self._inputs[k] = inputs
        self._marks[k] = mark.count, mark.epoch

    def _save(self, mark: Mark) -> None:
        self._saved.append(_Saved(self._step_number, self._fmu.state(), mark))
        while len(self._saved) > 1 and (
            self._saved[1].step_number <= self._step_number - self._length or len(self._saved) > _MAX_STATES
        ):
            self._fmu.free(self._saved.popleft().state)

    def back(self, steps: int) -> tuple[Mark, NDArray[np.float64], NDArray[np.float64]]:
        """Restore the last saved state that is not after the step that lies `steps` back.

        `steps`: number of steps, at most the property `steps`.

        Returns
        -------
        Mark
            The step whose state was restored, with count and epoch of the requested step.
        ndarray of shape (inputs,)
            Inputs at the requested step.
        ndarray of shape (k, inputs)
            Inputs of the steps to repeat.
        """
        target = self._step_number - steps
        while self._saved[-1].step_number > target:
            self._fmu.free(self._saved.pop().state)
        saved = self._saved[-1]
        self._fmu.restore(saved.state)
        self._step_number = target
        k = np.arange(saved.step_number + 1, target + 1) % len(self._inputs)
        row = target % len(self._inputs)
        count, epoch = self._marks[row].tolist()
        return Mark(count, epoch, saved.mark.begin, saved.mark.steps), self._inputs[row].copy(), self._inputs[k]

    def clear(self) -> None:
        """Free all states."""
        while self._saved:
            self._fmu.free(self._saved.pop().state)
