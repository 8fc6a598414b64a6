"""Choice of methods by name, and refusals."""

import numpy as np
import pytest

from mbs import Model, Settings, Simulation, SimulationError, compile, simulate
from mbs.scenes import prototype_car
from tests.flexible_engine.bodies import bar
from tests.methods.models import driven, swing
from tests.methods.rolling_models import sleigh


def test_an_unknown_method_is_refused_with_the_names_there_are():
    with pytest.raises(ValueError, match="'energy_momentum_4'"):
        Settings(method="rk4")
    with pytest.raises(ValueError, match="rho_infinity"):
        Settings(rho_infinity=1.5)


def followed() -> Model:
    """An arm whose angle follows an input through a filter."""
    m = Model("rack", dimension=2)
    arm = m.body("arm", mass=1.0, com=(0.5, 0.0), inertia=0.1)
    m.revolute("pivot", m.ground, arm, point=(0.0, 0.0))
    angle = m.relative_angle("angle", m.ground, arm)
    m.drive("motor", angle, m.guide_input("follow", input=m.input("target"), frequency=2.0, unit="rad"))
    bob = m.body("bob", mass=1.0, com=(1.0, -0.3), inertia=0.02)
    m.revolute("end", arm, bob, point=(1.0, 0.0))
    return m


BACKWARDS = (
    "'energy_momentum_4' takes no element states or filtered driving functions, no lookup-table bodies, and no "
    "damping. 'ali3p' "
)
TREE = "rigid bodies that revolute and prismatic joints"


@pytest.mark.parametrize(
    ("method", "model", "message"),
    [
        ("energy_momentum_4", swing(1.0), BACKWARDS),
        ("energy_momentum_4", followed(), BACKWARDS),
        ("radau_5", prototype_car.build(), "takes no element states"),
        ("radau_5", sleigh(0.0), "no rolling"),
        ("semi_recursive", driven(), f"{TREE}.*driving functions or switches"),
        ("semi_recursive", sleigh(0.0), "joint"),
    ],
)
def test_a_model_that_a_method_cannot_step_is_refused_and_stays(method, model, message):
    simulation = Simulation(compile(model), settings=Settings(method=method))
    before = simulation.save()
    with pytest.raises(SimulationError, match=message):
        simulation.step(0.01)
    assert simulation.save() == before


def test_generalised_alpha_damps_a_stiff_oscillation_and_the_trapezoidal_rule_does_not():
    m = Model("stiff", dimension=2, gravity=(0.0, 0.0))
    mass = m.point_mass("mass", mass=1.0, position=(1.01, 0.0))
    m.torsional_spring_damper("spring", mass.point(None).components[0], stiffness=1e8, free_angle=1.0)
    m.sense_energy("energy", "total")
    system, h = compile(m), 0.01  # 100 rad of phase a step
    energy_ratios = {}
    for rho in (0.0, 0.5, 0.9):
        run = simulate(
            system, 0.5, h, settings=Settings(method="ali3p_generalised_alpha", rho_infinity=rho), estimate_error=False
        )
        energy_ratios[rho] = run["energy"][-1] / run["energy"][0]
    kept = simulate(system, 0.5, h, estimate_error=False)["energy"]
    assert energy_ratios[0.0] < 1e-6
    assert energy_ratios[0.0] < energy_ratios[0.5] < energy_ratios[0.9] < 0.1
    assert kept[-1] > 0.5 * kept[0]
    assert np.all(np.isfinite(kept))


@pytest.mark.parametrize(("rho", "flexible"), [(0.2, False), (0.5, True), (1.0, False)])
def test_generalised_alpha_steps_follow_its_recursion(rho, flexible):
    """A mass on a spring, k = 40 N/m, against the recursion of Chung and Hulbert, whose acceleration has a memory; a
    flexible body at rest beside it has no other past of steps.
    """
    m = Model("oscillator", gravity=(0.0, 0.0, 0.0))
    mass = m.point_mass("mass", mass=1.0, position=(1.5, 0.0, 0.0))
    m.torsional_spring_damper("spring", mass.point(None).components[0], stiffness=40.0, free_angle=1.0)
    m.sense_position("x", mass, (1.5, 0.0, 0.0), "x")
    if flexible:
        m.flexible_body("bar", bar((0, 0, 0), (1, 0, 0), dynamic=1), origin=(0.0, 5.0, 0.0))
    h, k = 0.05, 40.0
    s = Simulation(compile(m), settings=Settings(method="ali3p_generalised_alpha", rho_infinity=rho))
    am, af = (2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0)
    gamma = 0.5 + af - am
    beta = 0.25 * (gamma + 0.5) ** 2
    q, v, qdd = 0.5, 0.0, -k * 0.5
    a = qdd
    for _ in range(20):
        known = q + h * v + h * h * (0.5 - beta) * a + h * h * beta * (af * qdd - am * a) / (1.0 - am)
        new = known / (1.0 + h * h * beta * (1.0 - af) / (1.0 - am) * k)
        next_a = ((1.0 - af) * -k * new + af * qdd - am * a) / (1.0 - am)
        v += h * ((1.0 - gamma) * a + gamma * next_a)
        q, a, qdd = new, next_a, -k * new
        s.step(h)
        assert s.sensors["x"] - 1.0 == pytest.approx(q, abs=1e-9)
