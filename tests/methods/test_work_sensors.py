"""Work of force elements: closed forms, the balance of the energy by every method, states that go on, refusals."""

import numpy as np
import pytest

from mbs import Model, ModelError, Settings, Simulation, compile, simulate
from mbs.settings.settings import METHODS
from tests.methods.models import assert_saved_state_continues, driven, swing, triangle

QUIET = {"progress": False, "estimate_error": False}
NO_WORD = {"progress": False}
MASS = 2.0  # kg
SPEED = 3.0  # m/s
DAMPING = 1.5  # N s/m
# Order at which the balance of the swing closes as steps shrink; that of energy-momentum always does.
ORDERS = {"ali3p_generalised_alpha": 2, "runge_kutta_8": 8, "semi_recursive": 8, "semi_recursive_4": 4, "radau_5": 5}


def block():
    """A block that slides without gravity against a damper between it and a far wall along its way."""
    m = Model("block", dimension=2, gravity=(0.0, 0.0))
    mass = m.point_mass("block", mass=MASS, position=(0.0, 0.0))
    m.initial_velocity(mass, linear=(-SPEED, 0.0))
    damper = m.spring_damper("damper", (m.ground, (50.0, 0.0)), mass, stiffness=0.0, damping=DAMPING)
    m.sense_energy("work", "work", damper)
    m.sense_energy("lost", "nonconservative", "damper")
    return compile(m)


def oscillator(damping=2.0, stops=False):
    """Two rods whose spring and damper are sensed."""
    m = swing(damping, stops)
    m.sense_energy("work", "work", ["spring"])
    m.sense_energy("lost", "nonconservative", "spring")
    return m


def opened(run):
    """What the balance of the energy leaves open at the end, J."""
    return run["energy"][-1] - run["energy"][0] - run["lost"][-1]


@pytest.mark.parametrize(
    "method", [m for m in METHODS if m not in ("energy_momentum_4", "semi_recursive", "semi_recursive_4")]
)
def test_the_work_of_a_damper_is_the_energy_that_a_block_loses(method):
    t = 2.0
    run = simulate(block(), t, 0.002, method=method, **QUIET)
    taken = 0.5 * MASS * SPEED**2 * (1.0 - np.exp(-2.0 * DAMPING / MASS * t))
    assert run["lost"][-1] == pytest.approx(-taken, rel=1e-5)
    assert run["work"] == pytest.approx(run["lost"])
    assert run["work"][0] == 0.0


def motor_model():
    m = Model("motor", dimension=2)
    rotor = m.body("rotor", mass=1.0, com=(0.0, 0.0), inertia=0.5)
    m.revolute("pivot", m.ground, rotor, point=(0.0, 0.0))
    angle = m.relative_angle("angle", m.ground, rotor)
    record = m.torque_on("motor", angle, input=m.input("torque", unit="N.m"))
    m.sense_coordinate("angle", angle)
    m.sense_energy("work", "work", record)
    m.sense_energy("energy")
    return compile(m)


def test_another_method_continues_with_the_last_force():
    """The torque is 8 N m from the start of the first step of the trapezoidal rule."""
    simulation = Simulation(motor_model(), settings=Settings(method="radau_5"))
    simulation.set_input("torque", 4.0)
    simulation.step(0.01, 20)
    before = simulation.sensors
    simulation.set_input("torque", 8.0)
    simulation.instance.set_settings(**Settings(method="ali3p").kernel_fields())
    simulation.step(0.01)
    after = simulation.sensors
    assert after["work"] - before["work"] == pytest.approx(8.0 * (after["angle"] - before["angle"]), rel=1e-9)


@pytest.mark.parametrize("method", ["ali3p", "ali3p_no_projection", *ORDERS, "energy_momentum"])
def test_the_balance_of_a_damped_swing_closes_by_the_order_of_the_method(method):
    system = compile(oscillator())
    runs = [simulate(system, 0.8, h, method=method, **QUIET) for h in (0.04, 0.02)]
    lost = -runs[1]["lost"][-1]
    assert lost > 1.0
    coarse, fine = (abs(opened(r)) for r in runs)
    if method == "energy_momentum":
        assert coarse < 1e-8 * lost
    elif method == "ali3p":
        errors = [r.report.energy_error for r in runs]
        assert coarse / fine == pytest.approx(4.0, rel=0.2)
        residuals = [abs(opened(r) - error) for r, error in zip(runs, errors, strict=True)]
        assert residuals[0] / residuals[1] > 6.0  # what the error of the energy does not name is of third order
        assert residuals[1] < 0.04 * fine
    else:
        assert coarse / fine > 0.6 * 2.0 ** ORDERS.get(method, 2)


@pytest.mark.parametrize(("h", "share"), [(0.02, 6e-3), (0.005, 1e-4)])
def test_with_the_error_of_the_energy_the_balance_of_ali3p_closes_also_at_stops(h, share):
    run = simulate(compile(oscillator(stops=True)), 1.0, h, **QUIET)
    turned_over = abs(run["lost"][-1])
    assert turned_over > 0.5
    assert opened(run) == pytest.approx(run.report.energy_error, abs=share * turned_over)
    assert (
        abs(opened(run) + run["lost"][-1] - run.report.energy_error) > 0.5 * turned_over
    )  # without the work it does not


def test_springs_return_their_energy():
    m = triangle()
    m.sense_energy("work", "work", ["ac", "bc"])
    m.sense_energy("lost", "nonconservative", ["ac", "bc"])
    m.sense_energy("kinetic", "kinetic")
    system = compile(m)
    run = simulate(system, 1.0, 0.01, method="energy_momentum", **QUIET)
    assert np.abs(run["lost"]).max() < 1e-9
    assert np.abs(run["work"]).max() > 1.0
    assert run["kinetic"] - run["kinetic"][0] == pytest.approx(run["work"], abs=1e-8)
    composed = simulate(system, 1.0, 0.01, method="energy_momentum_4", **QUIET)
    assert composed["kinetic"][-1] - composed["kinetic"][0] == pytest.approx(composed["work"][-1], abs=1e-8)
    errors = [np.abs(simulate(system, 1.0, h, **QUIET)["lost"]).max() for h in (0.004, 0.002)]
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.2)


@pytest.mark.parametrize("method", ["ali3p", "energy_momentum", "runge_kutta_8", "radau_5", "semi_recursive"])
def test_steps_of_the_error_control_and_its_records_count_the_work_once(method):
    system = compile(oscillator())
    times = np.linspace(0.0, 0.8, 41)
    exact = simulate(system, 0.8, 1e-3, method="runge_kutta_8", every=20, **QUIET)
    run = simulate(system, 0.8, tolerance=1e-7, times=times, method=method, progress=False)
    np.testing.assert_allclose(run["lost"], exact["lost"], atol=2e-5 * abs(exact["lost"][-1]))


@pytest.mark.parametrize("method", ["energy_momentum", "semi_recursive"])
def test_steps_without_output_count(method):
    system = compile(oscillator())
    each, last = (simulate(system, 0.8, 0.01, method=method, every=n, **QUIET) for n in (1, 80))
    assert last["work"][-1] == each["work"][-1]
    assert last["lost"][-1] == each["lost"][-1]


@pytest.mark.parametrize("method", ["ali3p", "energy_momentum", "semi_recursive"])
def test_a_saved_state_continues_bit_for_bit(method):
    assert_saved_state_continues(compile(oscillator()), Settings(method=method))


def test_steps_in_halves_count_once():
    system = compile(oscillator(stops=True))
    run = simulate(system, 1.0, 0.02, settings=Settings(max_iterations=2), **QUIET)
    assert run.report.halvings > 0
    exact = simulate(system, 1.0, 1e-4, every=100, **QUIET)
    assert run["lost"][-1] == pytest.approx(exact["lost"][-1], rel=0.05)


def test_a_change_of_the_method_keeps_the_work():
    system = compile(oscillator())
    simulation = Simulation(system, settings=Settings(method="energy_momentum"))
    simulation.run(0.4, 1e-3)
    simulation.change_settings(Settings(method="ali3p"))
    simulation.run(0.8, 1e-3)
    exact = simulate(system, 0.8, 1e-3, method="runge_kutta_8", **QUIET)
    assert simulation.sensors["lost"] == pytest.approx(exact["lost"][-1], rel=1e-4)


@pytest.mark.parametrize(
    ("method", "left"),
    [("runge_kutta_8", 1e-11), ("radau_5", 2e-5), ("energy_momentum", 2e-4), ("energy_momentum_4", 1e-4)],
)
def test_the_work_of_a_guide_is_that_of_its_rows(method, left):
    """The mean of its powers at the ends of steps was off by 8e-5 of the energy with each of these methods."""
    m = driven()
    m.sense_energy("guides", "with guides")
    run = simulate(compile(m), 1.0, 0.01, method=method, **QUIET)
    energy_change = run["energy"] - run["energy"][0]
    assert energy_change.max() > 10.0
    assert np.abs(run["guides"] - energy_change).max() < left * energy_change.max()


def test_invalid_values_are_refused():
    m = swing(0.0)
    kinds = "'heat'; it must be kinetic, gravity, elastic, total, work, nonconservative, by inputs or with guides"
    with pytest.raises(ModelError, match=kinds):
        m.sense_energy("w", "heat", "spring")
    for elements in ([], ["spring", "spring"]):
        with pytest.raises(ModelError, match="at least one element and each once"):
            m.sense_energy("w", "work", elements)


def test_sensors_of_work_change_no_bit_of_the_motion():
    plain, sensed = (simulate(compile(m), 0.8, 0.01, **QUIET) for m in (swing(2.0), oscillator()))
    assert np.array_equal(plain["tip.y"], sensed["tip.y"])
    assert np.array_equal(plain["energy"], sensed["energy"])


@pytest.mark.parametrize("method", ["ali3p", "semi_recursive"])
def test_records_close_to_the_start_of_a_step_have_its_work(method):
    times = np.linspace(0.0, 1.0, 1001)
    run = simulate(motor_model(), 1.0, None, {"torque": 4.0}, tolerance=1e-3, times=times, method=method, **NO_WORD)
    assert run["work"] == pytest.approx(4.0 * run["angle"], abs=1e-6)


@pytest.mark.parametrize("method", ["ali3p", "runge_kutta_8"])
def test_work_is_continuous_where_inputs_jump(method):
    torque = ([0.0, 0.5, 0.5, 1.0], [4.0, 4.0, -4.0, -4.0])
    run = simulate(motor_model(), 1.0, None, {"torque": torque}, tolerance=1e-6, method=method, **NO_WORD)
    assert run["work"].max() == pytest.approx(4.0, rel=1e-3)  # 4 N m over 1 rad
    assert run["work"][-1] == pytest.approx(0.0, abs=1e-3)
