"""Bending beyond the range of linear modes is reported once, with the number of parts that a body needs."""

import warnings

import pytest

from mbs import BendingWarning, Simulation, simulate
from mbs.simulation.march import march
from tests.flexible_engine.bodies import soft_pendulum


def test_one_soft_body_is_warned_of_with_its_name_and_the_parts_it_needs() -> None:
    with pytest.warns(BendingWarning, match=r"body 'part 0' bends by 0\.045 rad .* Divide it into 2 or more") as caught:
        simulate(soft_pendulum(1), 2.0, 0.0025, progress=False)
    assert len(caught) == 1


def test_two_bodies_are_not_warned_of() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error", BendingWarning)
        simulate(soft_pendulum(2), 2.0, 0.0025, progress=False, estimate_error=False)


def test_a_stepped_run_warns_once() -> None:
    simulation = Simulation(soft_pendulum(1))
    with pytest.warns(BendingWarning):
        simulation.run(1.8, 0.005, progress=False)
    with warnings.catch_warnings():
        warnings.simplefilter("error", BendingWarning)
        simulation.run(2.0, 0.005, progress=False)


def test_a_run_with_flexible_bodies_is_watched_at_its_eighths_only() -> None:
    watched: list[int] = []
    march(
        Simulation(soft_pendulum(2)),
        1.6,
        0.01,
        None,
        2,
        False,
        watch=lambda values: watched.append(len(values)) or False,
    )
    assert watched == [11, 21, 31, 41, 51, 61, 71]
