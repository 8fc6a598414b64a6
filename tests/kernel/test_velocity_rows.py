"""Conditions on velocities in the kernel: what they add to the rows, and a state that continues bit for bit."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import root

from mbs.kernel.binding import LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.settings.settings import Settings
from tests.methods.rolling_models import ROLLING

from .scenes import sleigh

SEED = 5
H = 0.01
FD_TOLERANCE = 1e-8  # of central differences with that step
Array = NDArray[np.float64]


def started(method: str = "ali3p", **settings: float) -> Instance:
    instance = Instance(LoadedSystem(sleigh().to_bytes()))
    instance.set_settings(**Settings(method=method, **settings).kernel_fields())  # type: ignore[arg-type]
    instance.initialise(0.0)
    return instance


def dense(values: object) -> Array:
    a, v = sleigh().arrays(), np.array(values)
    ptr, J = np.array(a["row_ptr"]), np.zeros((3, 5))
    J[np.repeat(np.arange(3), np.diff(ptr)), np.array(a["row_col"])] = v
    return J


def test_the_matrix_stands_in_place_of_a_derivative_and_there_is_no_value() -> None:
    instance, b = started(), sleigh()
    rng = np.random.default_rng(SEED)
    scale = np.array(b.arrays()["row_scale"])
    for _ in range(5):
        q, qd = rng.normal(size=5), rng.normal(size=5)
        now = instance.evaluate(q, qd, None, 0.0)
        expected = scale[:, None] * [b.gradient(row, q) for row in b.rows]
        np.testing.assert_allclose(dense(now["jacobian"]), expected, atol=FD_TOLERANCE)
        assert np.array(now["phi"])[1:].tolist() == [0.0, 0.0]
        assert np.array(now["phi_t"]).tolist() == [0.0, 0.0, 0.0]
        ahead, behind = (dense(instance.evaluate(q + d * qd, qd, None, 0.0)["jacobian"]) for d in (1e-6, -1e-6))
        np.testing.assert_allclose(now["gamma"], (ahead - behind) @ qd / 2e-6, atol=FD_TOLERANCE)


def test_the_start_velocity_is_the_nearest_in_the_metric_of_the_mass_and_the_position_stays() -> None:
    b = sleigh()
    b.qd0 = np.array([0.5, 0.9, 0.2, 1.0, -1.0])
    instance = Instance(LoadedSystem(b.to_bytes()))
    instance.initialise(0.0)
    q, qd = (np.array(v) for v in instance.get_state()[:2])
    assert q.tolist() == b.q0.tolist()
    J = np.array([b.gradient(row, b.q0) for row in b.rows])
    np.testing.assert_allclose(J @ qd, 0.0, atol=1e-12)
    weight = np.linalg.solve(b.mass, J.T)
    np.testing.assert_allclose(qd, b.qd0 - weight @ np.linalg.solve(J @ weight, J @ b.qd0), atol=1e-9)


def test_closing_a_position_rolls_nothing() -> None:
    """The vector of the body comes to unit length, and turns, by its mass; body and wheel stay where they are."""
    b = sleigh()
    b.mass[3, 3] = 2.0
    instance = Instance(LoadedSystem(b.to_bytes()))
    instance.set_q([0.3, 0.1, 1.2, 0.9, 0.4])
    instance.initialise(0.0)
    x, y, along, across, angle = instance.get_state()[0]
    assert (x, y, angle) == pytest.approx((0.3, 0.1, 0.4), abs=1e-12)
    assert np.hypot(along, across) == pytest.approx(1.0, abs=1e-9)
    assert abs(0.8 * across - 0.6 * along) > 0.01


@pytest.mark.parametrize("method", ROLLING)
def test_a_restored_state_continues_bit_for_bit(method: str) -> None:
    instance = started(method)
    for _ in range(20):
        instance.step(H)
    saved = instance.save()
    other = Instance(LoadedSystem(sleigh().to_bytes()))
    other.restore(saved)
    for _ in range(30):
        instance.step(H)
        other.step(H)
    assert other.save() == instance.save()
    assert [bytes(v) for v in other.get_state()] == [bytes(v) for v in instance.get_state()]


@pytest.mark.parametrize("method", ROLLING)
def test_a_step_ends_with_velocities_and_accelerations_on_the_rows(method: str) -> None:
    instance, b = started(method), sleigh()
    for _ in range(50):
        instance.step(H)
    q, qd, qdd = (np.array(v) for v in instance.get_state()[:3])
    J = np.array([b.gradient(row, q) for row in b.rows])
    drift = (np.array([b.gradient(row, qd) for row in b.rows]) - [b.gradient(row, 0.0 * q) for row in b.rows]) @ qd
    projected = method != "ali3p_no_projection"
    assert np.abs(J @ qd).max() < (1e-10 if projected else 1e-4)
    assert np.abs(J @ qdd + drift)[1:].max() < (1e-5 if projected else 1e-1)
    assert np.abs(qd).max() > 0.5


def test_a_step_solves_the_trapezoidal_rule_with_the_rows_at_its_end() -> None:
    """M qdd1 + A1' lam = Q, Phi(q1) = 0, A(q1) qd1 = 0 with (17), (18), by a general solver."""
    instance, b = started("ali3p_no_projection", tolerance_r=1e-14, tolerance_phi=1e-14), sleigh()
    h = 0.05
    instance.set_input(0, 2.0)
    instance.step(h)
    q0, qd0, qdd0 = (np.array(v) for v in instance.get_state()[:3])
    push = np.array([2.0, 0.0, -0.3 * 2.0, 0.0, 0.0])

    def open_equations(x: Array) -> Array:
        qdd, lam = x[:5], x[5:]
        q, qd = q0 + h * qd0 + 0.25 * h**2 * (qdd0 + qdd), qd0 + 0.5 * h * (qdd0 + qdd)
        J = np.array([b.gradient(row, q) for row in b.rows])
        return np.concatenate([b.mass @ qdd + J.T @ lam - push, [b.value(b.rows[0], q)], J[1:] @ qd])

    actual = root(open_equations, np.concatenate([qdd0, np.zeros(3)]), tol=1e-13)
    instance.step(h)
    np.testing.assert_allclose(instance.get_state()[2], actual.x[:5], atol=1e-8)
    np.testing.assert_allclose(np.array(instance.get_state()[3]) * b.arrays()["row_scale"], actual.x[5:], atol=1e-8)


def test_a_step_of_energy_momentum_has_the_exact_derivative_of_its_rows() -> None:
    """With it one tangent and three iterations a step are enough; with another factor it takes twice as many."""
    instance = started("energy_momentum")
    instance.set_input(0, 2.0)
    for _ in range(20):
        instance.step(0.1)
    assert instance.report()["halvings"] == 0
    assert instance.report()["factorizations"] <= 30
    assert instance.report()["iterations"] <= 80
