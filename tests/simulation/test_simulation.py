"""Stepping: physics of a pendulum, exact save and restore, inputs, errors."""

import subprocess
import sys

import numpy as np
import pytest

from mbs import (
    AccuracyWarning,
    Pose,
    Settings,
    Simulation,
    SimulationError,
    simulate,
    simulate_many,
)
from tests.simulation.scenes import GRAVITY, LENGTH, MASS, free_mass, pendulum

H = 0.01
ENERGY_TOLERANCE = 5e-3  # J, of a trapezoidal step of 0.01 s on a swing of about 16 J
ROUND_OFF = 1e-12


@pytest.fixture(scope="module")
def system():
    return pendulum()


def test_a_pendulum_keeps_its_energy_and_its_length(system):
    run = simulate(system, 5.0, H)
    kinetic_at_bottom = MASS * GRAVITY * LENGTH
    assert np.ptp(run["bob.y"]) > 0.9 * LENGTH  # it does swing
    assert np.abs(run["energy"] - run["energy"][0]).max() < ENERGY_TOLERANCE * kinetic_at_bottom
    assert np.abs(np.hypot(run["bob.x"], run["bob.y"]) - LENGTH).max() < 1e-9


def test_the_first_acceleration_is_free_fall_of_a_level_rod(system):
    simulation = Simulation(system)
    assert simulation.sensors["bob.ax"] == pytest.approx(0.0, abs=ROUND_OFF)
    assert np.abs(simulation.state.qdd).max() == pytest.approx(GRAVITY, rel=1e-12)


def test_steps_by_hand_are_the_run(system):
    run = simulate(system, 0.5, H)
    simulation = Simulation(system)
    for k in range(1, 51):
        simulation.step(H)
        assert simulation.sensors["energy"] == run["energy"][k]
        assert simulation.sensors["bob.x"] == run["bob.x"][k]
    assert simulation.report == run.report


def test_every_and_chunks_record_the_same_states(system):
    fine = simulate(system, 1.0, H)
    coarse = simulate(system, 1.0, H, every=7)
    assert len(coarse.t) == 100 // 7 + 1
    assert coarse["bob.x"].tolist() == fine["bob.x"][::7].tolist()
    np.testing.assert_allclose(coarse.t, fine.t[::7], rtol=0.0, atol=ROUND_OFF)
    simulation = Simulation(system)
    halves = simulation.run(0.5, H), simulation.run(1.0, H)
    assert halves[1]["bob.x"].tolist() == fine["bob.x"][50:].tolist()


def test_time_is_counted_not_added(system):
    simulation = Simulation(system, t0=0.3)
    simulation.step(0.03, n=7)
    assert simulation.time == 0.3 + 7 * 0.03


def test_a_run_ends_at_the_last_whole_step(system):
    """What is told of is more than a hundredth of the run, and the step that is proposed ends there."""
    message = r"ends at 0\.9 s, a whole number of steps of 0\.3 s, instead of 1 s; h = 0\.25 ends there"
    with pytest.warns(AccuracyWarning, match=message):
        assert simulate(system, 1.0, 0.3, estimate_error=False).t[-1] == pytest.approx(0.9, abs=ROUND_OFF)
    with pytest.warns(AccuracyWarning, match=message):
        simulate_many(system, [], 1.0, 0.3)
    assert simulate(system, 1.0, 0.25, estimate_error=False).t[-1] == pytest.approx(1.0, abs=ROUND_OFF)
    assert simulate(system, 1.0, 0.03).t[-1] == pytest.approx(0.99, abs=ROUND_OFF)
    assert simulate(system, 0.3, 0.1).t[-1] == pytest.approx(0.3, abs=ROUND_OFF)
    for h in (0.001, 0.003, 0.01):  # the nearest numbers of 32 bits lie above or below
        assert simulate(system, 0.3, np.float32(h)).t[-1] == pytest.approx(0.3, rel=1e-7)


CONTINUE = """
import sys
from pathlib import Path
from mbs import Simulation, System
folder = Path(sys.argv[1])
simulation = Simulation(System.load(folder / "pendulum.ali3"))
simulation.restore((folder / "state").read_bytes())
simulation.step(0.01, n=40)
(folder / "end").write_bytes(simulation.save())
"""


def test_a_restored_state_continues_bit_for_bit_also_in_another_process(tmp_path):
    system = pendulum(damped=True)
    simulation = Simulation(
        system, settings=Settings(max_iterations=12), inputs={"push x": 3.0}, parameters={"tie stiffness": 50.0}
    )
    simulation.step(H, n=25)
    state = simulation.save()
    simulation.step(H, n=40)
    end = simulation.save()
    assert end != state

    simulation.step(H, n=3)
    simulation.restore(state)
    assert simulation.save() == state
    simulation.step(H, n=40)
    assert simulation.save() == end

    system.save(tmp_path / "pendulum.ali3")
    (tmp_path / "state").write_bytes(state)
    subprocess.run([sys.executable, "-c", CONTINUE, str(tmp_path)], check=True)
    assert (tmp_path / "end").read_bytes() == end


def test_a_state_of_another_system_is_refused(system):
    with pytest.raises(SimulationError, match="The saved state was refused"):
        Simulation(system).restore(Simulation(free_mass()).save())


def test_two_simulations_of_one_system_do_not_touch_each_other(system):
    alone = simulate(system, 0.2, H, {"push x": 5.0})
    pushed, other = Simulation(system, inputs={"push x": 5.0}), Simulation(system)
    for _ in range(20):
        pushed.step(H)
        other.step(H)
    assert pushed.sensors["bob.x"] == alone["bob.x"][-1]
    assert other.sensors["bob.x"] != alone["bob.x"][-1]


class TestInputs:
    def test_a_constant_force_gives_the_parabola_exactly(self):
        run = simulate(free_mass(), 1.0, H, {"push x": 4.0})
        np.testing.assert_allclose(run["x"], 0.5 * 4.0 / MASS * run.t**2, rtol=0.0, atol=ROUND_OFF)

    def test_the_value_at_the_end_of_the_step_counts(self):
        run = simulate(free_mass(), 1.0, H, {"push x": lambda t: 10.0 * t})
        np.testing.assert_allclose(run["push"], 10.0 * run.t, rtol=0.0, atol=ROUND_OFF)
        # the trapezoidal rule weighs start and end of each step alike, so a linear force gives the exact velocity
        np.testing.assert_allclose(run["v"], 5.0 * run.t**2 / MASS, rtol=0.0, atol=ROUND_OFF)

    def test_inputs_without_a_signal_stay_as_set_also_after_a_restore(self):
        simulation = Simulation(free_mass(), inputs={"push x": 4.0})
        state = simulation.save()
        simulation.set_input("push x", 0.0)
        simulation.restore(state)
        run = simulation.run(0.5, H, inputs={"push y": 1.0})
        assert run["push"].tolist() == [4.0] * 51

    def test_names_and_ranges_are_checked(self, system):
        with pytest.raises(ValueError, match="no input 'push'; the System has: push x, push y"):
            simulate(system, 1.0, H, {"push": 1.0})
        with pytest.raises(ValueError, match=r"'push x' is 110 N at t = 1.1 s; it must lie between -100 and 100"):
            simulate(system, 2.0, 0.1, {"push x": lambda t: 100.0 * t})


class TestParameters:
    def test_a_parameter_changes_the_motion(self):
        system = pendulum(damped=True)
        soft, stiff = (simulate(system, 0.5, H, parameters={"tie stiffness": k}) for k in (10.0, 90.0))
        default = simulate(system, 0.5, H)
        named = simulate(system, 0.5, H, parameters={"tie stiffness": 30.0})
        assert soft["bob.x"][-1] != stiff["bob.x"][-1]
        assert named["bob.x"].tolist() == default["bob.x"].tolist()

    @pytest.mark.parametrize("value", [-1.0, 101.0, float("nan")])
    def test_its_range_is_checked(self, value):
        with pytest.raises(ValueError, match="'tie stiffness' is set to .* N/m; it must lie between 0 and 100"):
            simulate(pendulum(damped=True), 0.5, H, parameters={"tie stiffness": value})

    def test_its_name_is_checked(self, system):
        with pytest.raises(ValueError, match="no parameter 'tie'; the System has: none"):
            simulate(system, 0.5, H, parameters={"tie": 1.0})


class TestErrors:
    def hopeless(self):
        """No step can meet this tolerance."""
        return Settings(tolerance_r=1e-300, max_iterations=3, max_halvings=1)

    def test_a_failing_step_names_time_reason_and_joint_and_keeps_the_state(self, system):
        simulation = Simulation(system, settings=self.hopeless(), t0=1.0)
        before = simulation.state
        with pytest.raises(SimulationError, match=r"step from t = 1 s with h = 0.01 s failed: .*'") as caught:
            simulation.step(H)
        assert caught.value.time == simulation.time == 1.0
        assert caught.value.status > 0
        assert simulation.state.q.tolist() == before.q.tolist()
        assert simulation.report.failures == 1

    def test_what_is_refused_before_solving_names_no_constraint(self, system):
        with pytest.raises(SimulationError, match=r"starting Pose\(.*speed=1.0, .*\) was refused") as caught:
            Simulation(system, pose=Pose(speed=1.0))  # tied to the ground
        assert "Worst" not in str(caught.value)

    def test_a_failed_run_returns_its_recorded_rows(self, system):
        def jolt(t):
            return 0.0 if t < 0.205 else 1e200

        reference = simulate(system, 0.2, H)
        with pytest.raises(SimulationError, match=r"step from t = 0.2 s") as caught:
            simulate(system, 0.5, H, {"push y": jolt}, every=2)
        part = caught.value.trajectory
        assert part is not None
        assert part.t[-1] == pytest.approx(0.2, abs=ROUND_OFF)
        assert part["bob.x"].tolist() == reference["bob.x"][::2].tolist()

    @pytest.mark.parametrize("n", [-1, 2.5])
    def test_an_invalid_number_of_steps_is_refused(self, system, n):
        with pytest.raises(ValueError, match="whole number of steps"):
            Simulation(system).step(H, n)

    @pytest.mark.parametrize("h", [0.0, -0.01, float("nan"), float("inf")])
    def test_the_step_must_be_positive(self, system, h):
        with pytest.raises(ValueError, match="The step h is .* s; it must be positive and finite"):
            simulate(system, 1.0, h)

    def test_the_end_must_not_lie_before_the_start(self, system):
        with pytest.raises(ValueError, match="t_end is 1.0 s; it must be finite and not before 2 s"):
            simulate(system, 1.0, H, t0=2.0)

    def test_every_must_be_positive(self, system):
        with pytest.raises(ValueError, match="every = 0; it must be at least 1"):
            simulate(system, 1.0, H, every=0)


def test_progress_reaches_the_end(system):
    shares: list[float] = []
    simulate(system, 1.0, H, progress=shares.append, estimate_error=False)
    assert shares == sorted(shares)
    assert shares[-1] == 1.0


def test_a_run_reports_cost_and_settings(system):
    settings = Settings(update="paper", tolerance_r=1e-7)
    run = simulate(system, 1.0, H, settings=settings)
    assert run.settings is settings
    assert run.report.steps == 100
    assert 100 <= run.report.iterations <= 400
    at_start = Simulation(system, settings=settings).report.factorizations
    assert run.report.factorizations == run.report.iterations + at_start
    assert run.wall_s > 0.0
    assert run.realtime_factor == pytest.approx(1.0 / run.wall_s)


def test_static_equilibrium_hangs_down():
    simulation = Simulation(pendulum(damped=True), inputs={"push x": 1.0})
    simulation.static_equilibrium()
    x, y = simulation.sensors["bob.x"], simulation.sensors["bob.y"]
    stay = simulation.run(2.0, H)
    assert y < 0.0 < x
    assert np.hypot(stay["bob.x"] - x, stay["bob.y"] - y).max() < 1e-8
