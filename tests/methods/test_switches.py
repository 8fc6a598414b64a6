"""Rows that come and go at run time: a pin on the end of a double pendulum, and the PUMA of the paper."""

import numpy as np
import pytest

from benchmarks.methods.kernel_methods import TREE_ONLY
from mbs import Model, ModelError, Settings, Simulation, compile
from mbs.scenes import puma
from mbs.settings.settings import METHODS

H = 0.005
TIP = (1.0, 1.0)
CATCH = 0.5  # s
RELEASE = 1.5  # s
END = 2.5  # s


def pendulum(on: bool = False) -> Model:
    m = Model("double pendulum", dimension=2)
    first = m.body("first", mass=1.0, com=(0.5, 0.0), inertia=1.0 / 12.0)
    second = m.body("second", mass=1.0, com=(1.0, 0.5), inertia=1.0 / 12.0)
    m.revolute("pivot", m.ground, first, point=(0.0, 0.0))
    m.revolute("knee", first, second, point=(1.0, 0.0))
    m.sense_joint("pin.fy", m.pin("tip", second, TIP, on=on), "y")
    for c in "xy":
        m.sense_position(f"tip.{c}", second, TIP, c)
        m.sense_position(f"tip.v{c}", second, TIP, c, order=1)
    m.sense_energy("kinetic", "kinetic")
    m.sense_energy("energy", "total")
    return m


@pytest.fixture(scope="module")
def system():
    return compile(pendulum())


@pytest.mark.parametrize("method", [m for m in METHODS if m not in TREE_ONLY])  # no switches
def test_a_point_is_held_where_it_is_and_let_go(system, method):
    simulation = Simulation(system, settings=Settings(method=method))
    free = simulation.run(CATCH, H)
    before = simulation.sensors
    jump = simulation.set_switch("tip", True)
    after = simulation.sensors
    assert simulation.switch("tip")
    assert jump == pytest.approx(after["energy"] - before["energy"], abs=1e-12) == simulation.report.energy_jump
    assert jump < -1.0  # an impact takes energy
    assert np.hypot(after["tip.vx"], after["tip.vy"]) < 1e-10 < np.hypot(before["tip.vx"], before["tip.vy"])
    pinned = simulation.run(RELEASE, H)
    for c in "xy":
        assert np.abs(pinned[f"tip.{c}"] - free[f"tip.{c}"][-1]).max() < 1e-9
    assert np.abs(pinned["pin.fy"]).max() > 1.0
    assert abs(simulation.set_switch("tip", False)) < 1e-9  # letting go costs nothing
    again = simulation.run(END, H)
    assert np.ptp(again["tip.x"]) > 0.5
    assert again["pin.fy"][-1] == 0.0


def test_a_pin_closed_before_the_start_holds_the_drawn_point(system):
    """Not the point where the bodies stand when it closes: that is the start's to find."""
    simulation = Simulation(system)
    simulation.instance.reset()
    simulation.instance.set_q(list(system.arrays["q0"] + 0.01), [0.0] * system.nq)
    simulation.instance.set_switch(0, True)
    simulation.instance.initialise(0.0)
    assert [simulation.sensors[f"tip.{c}"] for c in "xy"] == pytest.approx(TIP, abs=1e-9)


def test_the_impact_is_the_one_of_least_kinetic_energy_lost(system):
    """Gauss: the projection is orthogonal in the mass metric, T_before = T_after + T_of the velocity taken."""
    simulation = Simulation(system)
    simulation.run(CATCH, H)
    before = simulation.state
    jump = simulation.set_switch("tip", True)
    after = simulation.state
    a = system.arrays
    M = np.zeros((system.nq, system.nq))
    for i in range(system.nq):
        M[i, a["mass_col"][a["mass_ptr"][i] : a["mass_ptr"][i + 1]]] = a["mass_val"][
            a["mass_ptr"][i] : a["mass_ptr"][i + 1]
        ]
    taken = before.qd - after.qd
    assert 0.5 * taken @ M @ taken == pytest.approx(-jump, rel=1e-9)
    assert np.array_equal(before.q, after.q)


def test_a_saved_state_knows_its_switches_and_anchors(system):
    simulation = Simulation(system)
    simulation.run(CATCH, H)
    simulation.set_switch("tip", True)
    simulation.run(1.0, H)
    other = Simulation(system)
    other.restore(simulation.save())
    assert other.switch("tip")
    simulation.run(RELEASE, H)
    other.run(RELEASE, H)
    assert simulation.save() == other.save()


def test_a_pin_that_starts_on_holds_from_the_start():
    simulation = Simulation(compile(pendulum(on=True)))
    run = simulation.run(0.5, H)
    assert np.ptp(run["tip.y"]) < 1e-9
    assert simulation.set_switch("tip", True) == 0.0  # it is on already
    simulation.set_switch("tip", False)
    assert np.ptp(simulation.run(1.0, H)["tip.y"]) > 0.1


def test_wrong_names_and_the_ground_are_refused(system):
    with pytest.raises(ValueError, match="no switch 'hand'; the System has: tip"):
        Simulation(system).set_switch("hand", True)
    m = Model("m", dimension=2)
    with pytest.raises(ModelError, match="needs a body that can move"):
        m.pin("p", m.ground, (0.0, 0.0))


@pytest.fixture(scope="module")
def robot():
    return compile(puma.build())


@pytest.mark.parametrize(("h", "bound_m"), [(0.01, 1e-3), (0.05, 0.03), (0.1, 0.2)])
def test_the_robot_comes_back_also_where_the_paper_does_not_converge(robot, h, bound_m):
    """Paper, Table 2, of its own manoeuvre: 0.53 mm, 3.4 mm, no convergence."""
    replay = puma.replay(robot, h, estimate_error=False)
    assert replay.error < bound_m
    assert replay.path_error() < bound_m
    assert abs(replay.jumps_J[0]) < 1e-3  # it arrives at rest
    assert abs(replay.jumps_J[1]) < 1e-9


def test_the_robot_s_error_is_second_order_and_with_order_four_that_of_the_table(robot):
    steps = np.array([0.02, 0.01, 0.005])
    errors = np.array([puma.replay(robot, h, estimate_error=False).path_error() for h in steps])
    assert 1.8 < np.polyfit(np.log(steps), np.log(errors), 1)[0] < 2.4
    assert puma.replay(robot, 0.01, Settings(method="energy_momentum_4"), estimate_error=False).path_error() < 5e-5


def test_the_robot_s_error_is_made_before_the_pin_closes_and_grows_after(robot):
    """Torques without feedback: the second-order error of the first stage is amplified by the motion that follows."""
    small = 0.002
    whole = puma.replay(robot, 0.02, estimate_error=False)
    first, rest = puma.replay(robot, (0.02, small, small)), puma.replay(robot, (small, 0.02, 0.02))
    at_pin = np.linalg.norm(first.hand[first.times <= 2.0][-1] - puma.pinned_position())
    assert first.error == pytest.approx(whole.error, rel=0.1)
    assert rest.error < 0.1 * whole.error
    assert first.error > 10.0 * at_pin
