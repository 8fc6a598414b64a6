"""Beams that turn: what the damped first steps leave of their energy, and pairs of them far from the origin."""

import numpy as np
import pytest

import mbs
from mbs.flexible.component_modes import craig_bampton
from mbs.flexible.fixed_interface import Interface
from mbs.flexible.reduced_body import ReducedBody
from tests.flexible.structures import straight

RATE = 10.0  # rad/s
LENGTH = 1.5


@pytest.fixture(scope="module")
def reduced() -> ReducedBody:
    return craig_bampton(straight(4).finite_element_model(), 0, [Interface(4, rotations=True)], 4)


def energies(body: ReducedBody, h: float) -> np.ndarray:
    """Of a free beam, J, at the start and after the damped first steps."""
    m = mbs.Model("thrown", gravity=(0.0, 0.0, 0.0))
    m.initial_velocity(m.flexible_body("beam", body), (1.0, 0.0, 0.0), (0.0, 0.3 * RATE, RATE))
    run = mbs.Simulation(mbs.compile(m))
    start = run.report.energy
    run.step(h, 10)
    return np.array([start, run.report.energy])


def test_the_damped_first_steps_lose_energy_of_fourth_order(reduced: ReducedBody) -> None:
    """They lost 1.9 (w h)^2 of it, as the first has one acceleration and the others its rate from there."""
    lost = [1.0 - energies(reduced, wh / RATE)[1] / energies(reduced, wh / RATE)[0] for wh in (0.05, 0.1)]
    assert abs(lost[0]) < 0.05 * 0.05**2
    assert abs(lost[1]) < 0.1 * 0.1**2


def test_two_beams_on_a_hinge_far_from_the_origin(reduced: ReducedBody) -> None:
    """Their rows have positions of both, which a place far away resolves to 1e-8 m: then steps end without halvings,
    which were needed, and without iterations up to the limit."""
    place = 1e8  # m
    m = mbs.Model("two beams")
    m.floating = True
    one, other = (m.flexible_body(name, reduced) for name in ("one", "other"))
    m.revolute("hinge", one.interface(4), other.interface(4), point=(LENGTH, 0.0, 0.0), axis=(0.0, 0.0, 1.0))
    m.sense_position("z", one.interface(4), (LENGTH, 0.0, 0.0), "z")
    m.sense_vector(
        "gap",
        one.interface(4).point((LENGTH, 0.0, 0.0)) - one.point((0.0, 0.0, 0.0)),
        [m.ground.vector((1.0, 0.0, 0.0))],
    )
    system = mbs.compile(m)
    runs = [mbs.Simulation(system, pose=mbs.Pose(x=x, y=-x, speed=3.0, yaw_rate=3.0)) for x in (0.0, place)]
    for run in runs:
        run.step(0.002, 100)
    near, far = runs
    assert far.report.halvings == 0
    assert far.report.iterations < 4 * near.report.iterations
    assert far.sensors["z"] == pytest.approx(near.sensors["z"], abs=1e-9)
    assert far.sensors["gap"] == pytest.approx(near.sensors["gap"], abs=1e-9 + 4.0 * np.spacing(place))
