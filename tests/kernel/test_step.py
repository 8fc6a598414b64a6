"""ALi3-P steps of systems made by hand: energy, convergence, projections, halving, refusal, the clock."""

import numpy as np
import pytest

from mbs.kernel import binding
from mbs.kernel.binding import KernelError, LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.kernel.header.enumerations import DrivingFunctionType, ElementType

from .scenes import GRAVITY, everything, four_bar, pendulum
from .system_builder import Element, Row, SystemBuilder, distance_row

ROUND_OFF = 1e-12  # relative
ACCELERATION = 2e-9  # relative; they only steer the next prediction
A01 = {
    1.0: (0.986292, -0.165011),
    5.0: (-0.942305, -0.334754),
    10.0: (-0.275087, -0.961419),
}  # project data, benchmark A01
ENERGY_BOUND_J = {0.01: 0.10, 0.03: 1.0, 0.05: 3.2}  # the paper's Table 1: 0.21, 0.83, 9.03


def start(builder: SystemBuilder, **settings: float) -> Instance:
    instance = Instance(LoadedSystem(builder.to_bytes()))
    instance.set_settings(**settings)
    instance.initialise(0.0)
    return instance


def run(instance: Instance, h: float, steps: int) -> np.ndarray:
    out = np.empty((steps, instance.system.sizes.ns))
    assert instance.run(h, steps, None, 1, out) == steps
    return out


def test_pendulum_follows_its_reference_with_order_two() -> None:
    error = {}
    for h in (0.004, 0.002, 0.001):
        path = run(start(pendulum()), h, round(10.0 / h))
        error[h] = max(np.hypot(*(path[round(t / h) - 1, :2] - xy)) for t, xy in A01.items())
    assert error[0.001] < 2e-4
    for h in (0.004, 0.002):
        assert 3.6 < error[h] / error[h / 2] < 4.4  # order two


@pytest.mark.parametrize("h", [0.01, 0.03, 0.05])
def test_double_four_bar_keeps_its_energy_through_ten_singular_positions(h: float) -> None:
    instance = start(four_bar(2, [2, 2, 2]))
    before = instance.sensors()[2]
    energy = run(instance, h, int(10.0 / h))[:, 2] - before
    report = instance.report()
    assert -ENERGY_BOUND_J[h] < energy.min() < -0.01 * ENERGY_BOUND_J[h]  # trapezoidal rule with projections: a loss
    assert energy.max() < 0.2 * ENERGY_BOUND_J[h]
    assert report["halvings"] == 0
    assert report["iterations"] < (2.6 if h > 0.03 else 2.1) * report["steps"]
    assert report["max_iterations"] <= 8  # the steps that end at a singular position


@pytest.mark.parametrize("update", [0, 1], ids=["linearised", "paper"])
def test_both_multiplier_updates_end_in_the_same_step(update: int) -> None:
    states = []
    for alpha in (1e7, 1e8):
        tight = {"tolerance_r": 1e-11, "tolerance_phi": 1e-11, "max_iterations": 100}
        instance = start(four_bar(), update=update, alpha=alpha, **tight)
        run(instance, 0.01, 20)
        assert instance.report()["halvings"] == 0
        states.append(np.array(instance.get_state()[0]))
    reference = start(four_bar(), tolerance_r=1e-13, tolerance_phi=1e-13)
    run(reference, 0.01, 20)
    for q in states:
        np.testing.assert_allclose(q, np.array(reference.get_state()[0]), atol=1e-9)


def test_projected_rates_satisfy_the_constraints_to_round_off() -> None:
    instance = start(everything())
    instance.set_input(0, 0.7)
    row_ptr = np.array(everything().arrays()["row_ptr"])
    columns = np.array(everything().arrays()["row_col"])
    for _ in range(40):
        instance.step(0.01)
        q, qd, qdd, _, y = (np.array(v) for v in instance.get_state())
        values = {k: np.array(v) for k, v in instance.evaluate(q, qd, y, instance.time).items()}
        for k in range(len(row_ptr) - 1):
            part = slice(row_ptr[k], row_ptr[k + 1])
            J, c = values["jacobian"][part], columns[part]
            assert abs(values["phi"][k]) < 1e-9
            assert abs(J @ qd[c] + values["phi_t"][k]) < 2 * ROUND_OFF * (1.0 + abs(qd).max())
            assert abs(J @ qdd[c] + values["gamma"][k]) < ACCELERATION * (1.0 + abs(qdd).max())
    assert abs(qd).max() > 0.1  # it does move


def test_the_clock_is_an_integer_counter() -> None:
    instance = start(pendulum())
    for _ in range(1000):
        instance.step(0.1 / 8)
    assert instance.time == 1000 * (0.1 / 8)


def test_a_step_that_does_not_converge_is_halved_and_arrives_at_the_same_time() -> None:
    instance = start(four_bar(), max_iterations=2, tolerance_r=1e-12, tolerance_phi=1e-12)
    for _ in range(5):
        instance.step(0.1)
    report = instance.report()
    assert report["halvings"] > 0
    assert report["steps"] == 5
    assert report["failures"] == 0
    assert instance.time == pytest.approx(0.5, abs=1e-15)
    fine = start(four_bar())
    run(fine, 0.001, 500)
    np.testing.assert_allclose(instance.get_state()[0], fine.get_state()[0], atol=2e-2)


def test_a_refused_step_keeps_the_last_good_state() -> None:
    instance = start(four_bar(), max_iterations=1, max_halvings=2, tolerance_r=1e-300, tolerance_phi=1e-300)
    before = [bytes(part) for part in instance.get_state()]
    with pytest.raises(KernelError) as refusal:
        instance.step(0.01)
    assert refusal.value.status == binding.Status.NOT_CONVERGED
    assert [bytes(part) for part in instance.get_state()] == before
    assert instance.time == 0.0
    assert instance.report()["failures"] == 1
    assert instance.report()["steps"] == 0
    instance.set_settings(tolerance_r=1e-10, tolerance_phi=1e-10, max_iterations=20)
    instance.step(0.01)
    other = start(four_bar())
    other.step(0.01)
    assert [bytes(part) for part in instance.get_state()] == [bytes(part) for part in other.get_state()]


def test_a_step_that_the_past_misleads_starts_again_from_the_present() -> None:
    """A push that grew by 20 N a step stops growing: the parabola goes on growing, and one iteration cannot mend it."""

    def pushed(predictor: int) -> Instance:
        b = pendulum()
        b.q0, b.inputs = np.array([0.0, -1.0]), [(0.0, -1e3, 1e3)]
        b.elements = [Element(3, [b.signal({0: 1.0})], [1.0], [0])]
        instance = start(b)
        for k in range(6):
            instance.run(0.01, 1, np.array([20.0 * (k + 1)]))
        one = {"max_iterations": 1, "max_halvings": 0, "tolerance_r": 1e-7, "tolerance_phi": 1e-7}
        instance.set_settings(predictor=predictor, **one)
        before = instance.report()["iterations"]
        instance.step(0.01)
        assert instance.report()["iterations"] - before == (2 if predictor == 0 else 1)
        return instance

    past, present = pushed(0), pushed(1)
    assert [bytes(part) for part in past.get_state()] == [bytes(part) for part in present.get_state()]


def test_a_half_that_was_good_leaves_no_energy_in_the_balance() -> None:
    """Of a step whose first half is good and whose second is refused nothing stays, also not of its energy."""
    balance = ("energy_error", "open_power", "energy", "work", "kinetic_peak", "speed_peak", "velocity_path")
    instance = start(four_bar(), max_iterations=1, max_halvings=1, tolerance_r=1e-5, tolerance_phi=1e-5)
    good_halves = 0
    for _ in range(100):
        before, state = instance.report(), [bytes(part) for part in instance.get_state()]
        try:
            instance.step(0.1)
        except KernelError:
            after = instance.report()
            good_halves += int(after["iterations"] - before["iterations"] > 2)
            assert {name: after[name] for name in (*balance, "predictor_path")} == {
                name: before[name] for name in (*balance, "predictor_path")
            }
            assert [bytes(part) for part in instance.get_state()] == state
            instance.set_settings(max_iterations=20)
            instance.step(0.1)
            instance.set_settings(max_iterations=1)
    assert good_halves > 0


def test_an_energy_that_overflows_is_refused_and_the_state_stays() -> None:
    """Positions, velocities and forces are finite after the step; the energy of the spring, k x^2 / 2, is not."""
    b = SystemBuilder(np.array([[1.0]]), [0.0], [1e153])
    b.elements = [
        Element(ElementType.SCALAR_SPRING_DAMPER, [b.signal({0: 1.0})], [1e-4, 0.0, 0.0, 0.0, 1.0, 1.0], outputs=1)
    ]
    instance = start(b, tolerance_r=1e150)
    before = [bytes(part) for part in instance.get_state()]
    with pytest.raises(KernelError) as refusal:
        instance.step(100.0)
    assert refusal.value.status == binding.Status.NOT_FINITE
    assert [bytes(part) for part in instance.get_state()] == before


def test_rates_of_a_filter_that_overflow_are_refused() -> None:
    """Of a driving function that no row has: nothing else of the step sees them."""
    b = pendulum()
    b.inputs, b.guides = [(0.0, -1.0, 1.0)], [(DrivingFunctionType.OF_INPUT, 0, [1e200, 1.0, 0.0])]
    instance = start(b)
    instance.set_input(0, 0.5)
    before = [bytes(part) for part in instance.get_state()]
    with pytest.raises(KernelError) as refusal:
        instance.step(0.01)
    assert refusal.value.status == binding.Status.NOT_FINITE
    assert [bytes(part) for part in instance.get_state()] == before


def test_a_coordinate_without_mass_and_row_is_called_singular() -> None:
    b = SystemBuilder(np.diag([1.0, 0.0]), [0.0, 0.0], rows=[Row(0.0, {0: 1.0})])
    with pytest.raises(KernelError) as refusal:
        start(b)
    assert refusal.value.status == binding.Status.SINGULAR


@pytest.mark.parametrize("h", [0.0, float("nan"), float("inf")])
def test_steps_of_no_length_are_refused(h: float) -> None:
    instance = start(pendulum())
    with pytest.raises(KernelError) as refusal:
        instance.step(h)
    assert refusal.value.status == binding.Status.BAD_ARGUMENT


def test_fifty_kilometres_away_a_rod_takes_one_iteration_a_step() -> None:
    """It is drawn at the origin, and the round-off of its row is that of the drawing: where the row were evaluated at
    squares of the coordinates, some steps would take another iteration."""
    b = SystemBuilder(
        np.eye(4), [0.0, 0.0, 0.8, 0.6], [-0.6, 0.8, 0.6, -0.8], rows=[distance_row((0, 1), (2, 3), 1.0, False)]
    )
    zero = np.zeros(4)
    b.pose = dict.fromkeys(("pose_z", "pose_cos", "pose_sin", "pose_speed"), zero)
    b.pose |= {"pose_0": b.q0, "pose_x": np.array([1.0, 0.0, 1.0, 0.0]), "pose_y": np.array([0.0, 1.0, 0.0, 1.0])}
    instance = Instance(LoadedSystem(b.to_bytes()))
    instance.set_q(b.q0 + 5e4, b.qd0)
    instance.initialise(0.0)
    for _ in range(200):
        instance.step(0.01)
    assert instance.report()["iterations"] == 200
    x1, y1, x2, y2 = instance.get_state()[0]
    assert np.hypot(x2 - x1, y2 - y1) == pytest.approx(1.0, abs=1e-10)


def test_two_pendulums_in_neighbouring_rows_move_as_each_alone() -> None:
    """The last entry of a row and the first of the next belong to neighbouring coordinates here, in different rows."""

    def swung(angles: list[float]) -> np.ndarray:
        n = len(angles)
        rows = [distance_row((0.0, 0.0), (2 * i, 2 * i + 1), 1.0, True) for i in range(n)]
        places = np.ravel([[np.cos(a), np.sin(a)] for a in angles])
        instance = start(SystemBuilder(np.eye(2 * n), places, gravity=[0.0, -GRAVITY] * n, rows=rows))
        instance.run(0.01, 50)
        return np.array(instance.get_state()[0])

    together, alone = swung([3.1, -1.0]), [*swung([3.1]), *swung([-1.0])]
    assert together == pytest.approx(alone, abs=1e-9)


def test_a_linear_oscillator_takes_one_iteration_a_step() -> None:
    """Its tangent is exact, damping too, and Newton's method solves a linear equation at once."""
    b = SystemBuilder(np.eye(1), [0.5], [1.0])
    b.elements = [Element(2, [b.signal({0: 1.0})], [300.0, 40.0, 0.0, 0.0, 1.0, 1.0], outputs=1)]
    instance = start(b, tolerance_r=1e-13)
    run(instance, 0.02, 50)
    assert instance.report()["iterations"] == 50


def test_unsymmetric_damping_costs_few_iterations() -> None:
    """A strong damper that swings has an unsymmetric tangent; its symmetric part is kept, so Newton is linear there.

    Plain corrections take up to 17 iterations; mixing the last two takes 14, and both end in the same step.
    """
    b = SystemBuilder(np.eye(2), [0.5, 0.0], [0.0, 2.0], [0.0, -GRAVITY])
    signals = [b.signal({0: 1.0}), b.signal({1: 1.0})]
    b.elements = [Element(1, signals, [50.0, 60.0, 0.5, 1.0, 1.0, 0.0, 0.0, 1e9, 0.0], outputs=4)]
    instance = start(b, tolerance_r=1e-12, max_iterations=100)
    for _ in range(20):
        instance.step(0.1)
    assert instance.report()["max_iterations"] <= 15
    assert instance.report()["halvings"] == 0
    np.testing.assert_allclose(instance.get_state()[0], [0.61634700434, -0.35924089683], atol=1e-9)  # plain corrections
