"""Projections close the rates of the rows to what the positions know of them, and no further."""

import numpy as np
import pytest

from mbs import Model, System, compile, simulate
from mbs.kernel.binding import LoadedSystem
from mbs.kernel.binding.instance import Instance
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


@pytest.fixture(scope="module")
def parked() -> System:
    return compile(kerb_test.build(0))


def test_at_rest_round_off_is_not_projected(parked: System) -> None:
    """Rates of rows are 1e-13 m/s there, which the round-off of positions makes of them; relative to the velocity, as
    small, they took 3.9 and 4.0 sweeps a step."""
    sweeps, residual = _after(parked, 0.01)
    assert sweeps < 50  # 27
    assert residual < 1e-12


def test_rates_of_a_moving_car_are_projected() -> None:
    """Without a projection rows open by 1e-4 m/s a step."""
    _, residual = _after(compile(prototype_car.build(fidelity=0)), 0.005, 20.0)
    assert residual < 1e-10


def test_multipliers_of_a_large_mechanism_have_no_noise_at_small_steps() -> None:
    """Round-off of 50 m over h^2 made 1.5 % of noise in the forces of its joints; now 1e-9."""
    m = Model("crane", dimension=2)
    x, y = 50.0 * np.sin(0.3), -50.0 * np.cos(0.3)
    boom = m.body("boom", mass=1e5, com=(0.5 * x, 0.5 * y), inertia=1e5 * 50.0**2 / 12.0)
    load = m.body("load", mass=1e5, com=(x + 25.0, y), inertia=1e5 * 50.0**2 / 12.0)
    m.revolute("foot", m.ground, boom, point=(0.0, 0.0))
    m.revolute("tip", boom, load, point=(x, y))
    instance = Instance(LoadedSystem(compile(m).to_bytes()))
    instance.initialise()
    multipliers = []
    for _ in range(100):
        instance.step(1e-6)
        multipliers.append(np.array(instance.get_state()[3]))
    noise = np.diff(multipliers, n=2, axis=0)  # the motion itself changes them by (1e-3 s)^2 / (5 s^2) at most
    assert np.abs(noise).max() < 2e-8 * np.abs(multipliers).max()


def test_a_car_at_rest_is_not_repeated(parked: System) -> None:
    """Its velocities are round-off, and turn by 2000 radians in 4.5 s."""
    run = simulate(parked, 4.5, 0.005)
    assert abs(run.report.energy_error) < run.report.energy_floor
    assert run.report.energy_balance < 1e-5  # 3e-4 of what moves there, 1.7e-9 J
    assert run.accuracy.check_cost == 0.0
