"""Projections close the rates of the rows to what the positions know of them, and no further."""

from __future__ import annotations

import pytest

from mbs import System, compile
from mbs.kernel.binding import Instance, LoadedSystem
from mbs.scenes import kerb_test, prototype_car


def _after(system: System, h: float, speed: float | None = None) -> tuple[float, float]:
    """Sweeps of projections in 50 steps of a car at rest or in a bend, and by how much rates are open in the end."""
    instance = Instance(LoadedSystem(system.to_bytes()))
    if speed is not None:
        instance.set_pose(0.0, 0.0, 0.0, 0.0, speed)
    instance.initialise()
    inputs = None
    if speed is not None:
        inputs = system.arrays["input_start"].reshape(1, -1).repeat(50, axis=0)
        inputs[:, 0] = 0.5
    start = instance.report()
    instance.run(h, 50, inputs)
    end = instance.report()
    solves, iterations = (end[name] - start[name] for name in ("solves", "iterations"))
    return solves - iterations, end["velocity_violation"]


@pytest.mark.parametrize("h", [0.01, 0.002])
def test_at_rest_round_off_is_not_projected(h: float) -> None:
    """Rates of rows are 1e-13 m/s there, which the round-off of positions makes of them; relative to the velocity, as
    small, they took 3.9 and 4.0 sweeps a step."""
    sweeps, left = _after(compile(kerb_test.build(0)), h)
    assert sweeps < 50  # 27, 28
    assert left < 1e-14 / h


def test_rates_of_a_moving_car_are_projected() -> None:
    """Without a projection rows open by 1e-4 m/s a step."""
    _, left = _after(compile(prototype_car.build(fidelity=0)), 0.005, 20.0)
    assert left < 1e-10
