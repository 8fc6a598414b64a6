"""Inputs move at a limited rate in simulated time; a new start discards earlier requests."""

import numpy as np
import pytest

from hosts.simulator.driven_fmu import Inputs

H = 0.01
AT_ONCE = float("inf")


@pytest.fixture
def inputs() -> Inputs:
    return Inputs([0.0, 0.5, 1.0], [False, False, True])


def wants(*rows: tuple[float, float, int]) -> np.ndarray:
    return np.array(rows, float).ravel()


NONE = (0.0, 0.0, 0)


def test_rates_are_of_simulated_time(inputs: Inputs) -> None:
    inputs.want(wants((1.0, 2.0, 1), (0.0, AT_ONCE, 2), NONE))
    inputs.advance(H)
    assert inputs.values.tolist() == [0.02, 0.0, 1.0]
    for _ in range(48):
        inputs.advance(H)
    assert inputs.values[0] == pytest.approx(0.98)
    for _ in range(5):
        inputs.advance(H)
    assert inputs.values[0] == 1.0  # it arrives exactly
    inputs.want(wants((-1.0, 5.0, 3), NONE, NONE))
    inputs.advance(H)
    assert inputs.values[0] == pytest.approx(0.95)


def test_whole_numbers_change_at_once(inputs: Inputs) -> None:
    inputs.want(wants(NONE, NONE, (-1.2, 0.001, 1)))
    inputs.advance(H)
    assert inputs.values.tolist() == [0.0, 0.5, -1.0]


def test_a_new_start_forgets_wishes_before_it_and_keeps_those_after(inputs: Inputs) -> None:
    table = wants((1.0, AT_ONCE, 1), (0.9, AT_ONCE, 2), NONE)
    inputs.want(table)
    inputs.advance(H)
    inputs.restart(2.0)
    inputs.want(table)
    inputs.advance(H)
    assert inputs.values.tolist() == [0.0, 0.5, 1.0]
    inputs.want(wants((1.0, AT_ONCE, 3), (0.9, AT_ONCE, 2), NONE))
    inputs.advance(H)
    assert inputs.values.tolist() == [1.0, 0.5, 1.0]
