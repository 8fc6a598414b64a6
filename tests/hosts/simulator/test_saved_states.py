"""Rewinding to any step of the last 30 s, in constant memory."""

from typing import Any

import numpy as np
import pytest

from hosts.simulator.saved_states import EVERY, SECONDS, Mark, SavedStates

H = 0.01


class Summed:
    """In place of an FMU: its state is the sum of its inputs, in an order that matters."""

    def __init__(self) -> None:
        self.value, self.held, self.most = 0.0, 0, 0

    def step(self, x: float) -> None:
        self.value = np.sin(self.value + x)

    def state(self) -> Any:
        self.held += 1
        self.most = max(self.most, self.held)
        return [self.value]

    def restore(self, state: Any) -> None:
        self.value = state[0]

    def free(self, state: Any) -> None:
        state.clear()  # a state that was freed cannot be restored
        self.held -= 1


@pytest.fixture
def fmu() -> Summed:
    return Summed()


def driven(fmu: Summed, steps: int) -> tuple[SavedStates, list[float]]:
    states, values = SavedStates(fmu, 1, H), [fmu.value]
    states.begin(np.zeros(1), Mark(0, 0, 0.0, 0))
    for k in range(1, steps + 1):
        fmu.step(0.1 * k)
        states.add(np.array([0.1 * k]), Mark(k, 0, 0.0, k))
        values.append(fmu.value)
    return states, values


@pytest.mark.parametrize("back", [1, 49, 50, 51, 777, 3000])
def test_every_step_of_the_past_is_reached(fmu: Summed, back: int) -> None:
    states, values = driven(fmu, 4000)
    mark, inputs, rows = states.back(back)
    assert (mark.count, mark.steps + len(rows)) == (4000 - back, 4000 - back)
    assert inputs == pytest.approx([0.1 * (4000 - back)])
    assert len(rows) < EVERY / H
    for row in rows:
        fmu.step(float(row[0]))
    assert fmu.value == values[4000 - back]
    # And from there on as before.
    fmu.step(0.1 * (4001 - back))
    assert fmu.value == values[4001 - back]


def test_memory_is_bounded_and_everything_is_freed(fmu: Summed) -> None:
    states, _ = driven(fmu, 20000)
    assert SECONDS <= states.seconds <= SECONDS + EVERY
    assert fmu.held <= SECONDS / EVERY + 2
    states.back(1500)
    assert states.seconds == pytest.approx(SECONDS - 15.0, abs=EVERY)
    states.clear()
    assert fmu.held == 0


def test_new_starts_without_steps_do_not_fill_the_memory(fmu: Summed) -> None:
    states = SavedStates(fmu, 1, H)
    for epoch in range(5000):
        states.begin(np.zeros(1), Mark(0, epoch, 0.0, 0))
    assert fmu.most <= 201


def test_going_back_does_not_cross_a_new_start(fmu: Summed) -> None:
    states, values = driven(fmu, 120)
    fmu.value = 5.0
    states.begin(np.array([7.0]), Mark(120, 1, 1.2, 0))
    fmu.step(1.0)
    states.add(np.array([1.0]), Mark(121, 1, 1.2, 1))
    mark, inputs, rows = states.back(1)
    assert (mark.epoch, mark.begin, inputs.tolist(), len(rows), fmu.value) == (1, 1.2, [7.0], 0, 5.0)
    mark, inputs, rows = states.back(1)
    assert (mark.epoch, mark.count, mark.begin) == (0, 120, 0.0)
    for row in rows:
        fmu.step(float(row[0]))
    assert fmu.value == values[120]


def test_a_step_so_short_that_the_past_would_fill_the_memory(fmu: Summed) -> None:
    states = SavedStates(fmu, 1000, 1e-7)
    assert states.bytes <= 100e6
