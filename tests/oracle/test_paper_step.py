"""Every step of the kernel is the step of the paper's equations, to round-off."""

from dataclasses import replace

import numpy as np
import pytest

from mbs import Model, Settings, Simulation, compile
from mbs.elements.spring_damper import SpringDamper
from mbs.scenes import bricard, double_four_bar
from tests.oracle.dense_mechanism import DenseMechanism
from tests.oracle.paper_step import PaperState, paper_step

EPS_REL = 1e-8  # 1 / (alpha h^2): the share of its digits that a sum with the penalty loses
POSITION = 1e-12  # m
VELOCITY = 1e-9  # of the largest velocity; positions over h, times the loss near a singular position
ACCELERATION = 1e-7  # of the largest acceleration; velocities over h
MULTIPLIER = 1e-6  # of the largest multiplier
PENALISED = 1e-14  # constraint units: what alpha turns into multipliers in equation (16)
STEPS = 60
SETTINGS = {
    "linearised": Settings(eps_rel=EPS_REL, predictor="acceleration"),
    # equation (16) adds alpha times the round-off of Phi to the multipliers, which bounds the residual it can reach;
    # with redundant constraints its multipliers drift, so the geometric term must not use them
    "paper": Settings(
        eps_rel=EPS_REL,
        update="paper",
        predictor="acceleration",
        geometric=False,
        tolerance_r=1e-7,
        max_iterations=100,
    ),
}


def sprung_pair():
    """Two hinged bodies under a spring-damper from the ground, falling."""
    m = Model("sprung pair", dimension=3, gravity=(0.0, 0.0, -9.81))
    arm = m.body("arm", mass=3.0, com=(0.5, 0.0, 0.0), inertia=(0.01, 0.3, 0.3))
    bob = m.body("bob", mass=1.0, com=(1.0, 0.2, -0.4), inertia=(0.05, 0.06, 0.02))
    m.revolute("hinge", m.ground, arm, point=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
    m.spherical("ball", arm, bob, point=(1.0, 0.0, 0.0))
    span = arm.point((0.8, 0.0, 0.0)) - m.ground.point((0.6, 0.3, 1.0))
    m.add(SpringDamper(stiffness=900.0, damping=40.0, free_length=0.7).record("strut", span))
    tie = bob.point((1.0, 0.2, -0.6)) - arm.point((0.3, 0.1, 0.0))
    m.add(SpringDamper(stiffness=200.0, damping=15.0, free_length=0.9).record("tie", tie))
    return m


SCENES = {"double four-bar": double_four_bar.build, "Bricard": bricard.build, "sprung pair": sprung_pair}


def relative(found, expected):
    return np.abs(found - expected).max() / np.abs(found).max()


def stepped(simulation, h):
    """Iterations and tangents of a step."""
    before = simulation.report.factorizations
    simulation.step(h)
    return simulation.report.last_iterations, simulation.report.factorizations - before


def oracle_step(system, before, settings, h, iterations):
    start = PaperState(before.q, before.qd, before.qdd, before.lam)
    alpha = 1.0 / (settings.eps_rel * h * h)
    return paper_step(
        DenseMechanism(system), start, h, alpha, *iterations, settings.update, settings.geometric, settings.project
    )


def agrees(after, expected, settings, h):
    alpha = 1.0 / (settings.eps_rel * h * h)
    multiplier = MULTIPLIER * np.abs(after.lam).max() + (PENALISED * alpha if settings.update == "paper" else 0.0)
    return (
        np.abs(after.q - expected.q).max() < POSITION
        and relative(after.qd, expected.qd) < VELOCITY
        and relative(after.qdd, expected.qdd) < ACCELERATION
        and np.abs(after.lam - expected.lam).max() < multiplier
    )


@pytest.mark.parametrize(("update", "h"), [("linearised", 0.01), ("linearised", 0.03), ("paper", 0.03)])
@pytest.mark.parametrize("scene", list(SCENES))
def test_every_step_is_that_of_the_paper(scene, update, h):
    system, settings = compile(SCENES[scene]()), SETTINGS[update]
    simulation = Simulation(system, settings=settings)
    for n in range(STEPS):
        before, result = simulation.state, stepped(simulation, h)
        assert simulation.report.halvings == 0
        expected = oracle_step(system, before, settings, h, result)
        assert agrees(simulation.state, expected, settings, h), f"step {n}"
    assert relative(simulation.state.q, system.arrays["q0"]) > 0.1  # it has moved


@pytest.mark.parametrize("scene", list(SCENES))
def test_the_comparison_distinguishes_variants(scene):
    system, settings, h = compile(SCENES[scene]()), SETTINGS["linearised"], 0.03
    simulation = Simulation(system, settings=settings)
    simulation.step(h, n=20)
    before, result = simulation.state, stepped(simulation, h)
    assert agrees(simulation.state, oracle_step(system, before, settings, h, result), settings, h)
    for change in ({"geometric": False}, {"update": "paper"}, {"project": False}):
        variant = oracle_step(system, before, replace(settings, **change), h, result)
        assert not agrees(simulation.state, variant, settings, h)


def test_without_projections_the_step_is_that_of_the_paper_too():
    system, settings, h = compile(double_four_bar.build()), replace(SETTINGS["linearised"], project=False), 0.01
    simulation = Simulation(system, settings=settings)
    for _ in range(30):
        before, result = simulation.state, stepped(simulation, h)
        expected = oracle_step(system, before, settings, h, result)
        assert agrees(simulation.state, expected, settings, h)
