"""Static equilibria that are left by the smallest disturbance: an upright rod on a torsional spring, and on its own."""

import warnings

import numpy as np
import pytest

from mbs import EquilibriumWarning, Model, Simulation, compile, linearise

WEIGHT = 9.81  # N m/rad: the stiffness below which the rod of 1 kg with its centre at 1 m falls


def rod(stiffness, angle=0.0):
    m = Model("upright rod", dimension=2)
    body = m.body("rod", mass=1.0, com=(np.sin(angle), np.cos(angle)), inertia=0.1)
    m.revolute("pivot", m.ground, body, point=(0.0, 0.0))
    m.torsional_spring_damper("spring", m.relative_angle("lean", m.ground, body), stiffness=stiffness, damping=0.1)
    m.sense_position("height", body, None, "y")
    return Simulation(compile(m))


@pytest.mark.parametrize("stiffness", [0.0, 0.5 * WEIGHT, 0.98 * WEIGHT])
def test_an_upright_rod_that_falls_is_reported_and_beside_it_there_is_a_stable_equilibrium(stiffness):
    simulation = rod(stiffness)
    with pytest.warns(EquilibriumWarning, match="the smallest disturbance grows"):
        simulation.static_equilibrium()
    assert max(mode.eigenvalue.real for mode in linearise(simulation).modes) > 0.1
    beside = rod(stiffness, angle=0.05)
    beside.static_equilibrium()
    assert beside.sensors["height"] < 0.99
    assert max(mode.eigenvalue.real for mode in linearise(beside).modes) < 0.0


@pytest.mark.parametrize("stiffness", [1.02 * WEIGHT, 1e6])
def test_an_upright_rod_that_stands_is_not_reported(stiffness):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rod(stiffness).static_equilibrium()


def test_a_model_that_starts_in_one_says_so_when_it_is_compiled():
    m = Model("upright rod", dimension=2)
    body = m.body("rod", mass=1.0, com=(0.0, 1.0), inertia=0.1)
    m.revolute("pivot", m.ground, body, point=(0.0, 0.0))
    m.start_in_equilibrium = True
    with pytest.warns(EquilibriumWarning, match="equilibrium of 'upright rod' is unstable") as caught:
        compile(m)
    assert [w.filename for w in caught] == [__file__]
