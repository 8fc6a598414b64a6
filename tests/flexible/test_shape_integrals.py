"""The collapsed mass matrix and forces against the literal ``B' M_FEM B`` of the paper, and against derivatives."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mbs.flexible.component_modes import craig_bampton
from mbs.flexible.inertia_integrals import ShapeIntegrals, shape_integrals
from mbs.flexible.reduced_body import ReducedBody
from tests.flexible.structures import portal

ROUND_OFF = 1e-12
DIFFERENCES = 1e-6
GRAVITY = np.array([0.3, -0.4, -9.81])

KINDS = [("lumped", False), ("lumped", True), ("consistent", False), ("consistent", True)]


@pytest.fixture(scope="module", params=KINDS, ids=["-".join(map(str, k)) for k in KINDS])
def body(request: pytest.FixtureRequest) -> ReducedBody:
    kind, rotary = request.param
    return craig_bampton(portal().finite_element_model(kind, rotary), "N0", ["N3", "N7"], 3)


def literal_B(body: ReducedBody, A: np.ndarray, eta: np.ndarray) -> np.ndarray:
    """Equations (10) and (11): rows 3 k to 3 k + 2 give the velocity of mass point k, shape (3 p, 12 + n)."""
    p, n = len(body.masses), body.n_modes
    b = body.mass_positions + body.mass_shapes @ eta
    B = np.zeros((3 * p, 12 + n))
    for k in range(p):
        rows = slice(3 * k, 3 * k + 3)
        B[rows, :3] = np.eye(3)
        for i in range(3):
            B[rows, 3 + 3 * i : 6 + 3 * i] = b[k, i] * np.eye(3)
        B[rows, 12:] = A @ body.mass_shapes[k]
    return B


def random_state(n: int, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """A, Ad (not even a rotation's: the columns are free coordinates), eta, etad."""
    rng = np.random.default_rng(seed)
    A = Rotation.random(random_state=seed).as_matrix()
    return A, rng.normal(size=(3, 3)), 0.05 * rng.normal(size=n), rng.normal(size=n)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_mass_matrix_is_the_literal_product(body: ReducedBody, seed: int) -> None:
    integrals = shape_integrals(body)
    A, _, eta, _ = random_state(body.n_modes, seed)
    B = literal_B(body, A, eta)
    literal = B.T @ (np.repeat(body.masses, 3)[:, None] * B)
    np.testing.assert_allclose(integrals.mass_matrix(A, eta), literal, atol=ROUND_OFF * np.abs(literal).max())


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_velocity_force_is_the_literal_product(body: ReducedBody, seed: int) -> None:
    integrals = shape_integrals(body)
    A, Ad, eta, etad = random_state(body.n_modes, seed)
    rd = np.array([0.3, -2.0, 1.0])
    qd = np.concatenate([rd, Ad.T.ravel(), etad])
    # dB/dt by a difference that is exact: B is linear in A and in eta
    Bd = (literal_B(body, A + Ad, eta) - literal_B(body, A, eta)) + (
        literal_B(body, A, eta + etad) - literal_B(body, A, eta)
    )
    literal = -literal_B(body, A, eta).T @ (np.repeat(body.masses, 3) * (Bd @ qd))
    found = integrals.velocity_force(A, Ad, eta, etad)
    np.testing.assert_allclose(found, literal, atol=1e-11 * np.abs(literal).max())


def test_mass_matrix_and_velocity_force_come_from_one_kinetic_energy(body: ReducedBody) -> None:
    """Lagrange: d/dt(M qd) - dT/dq = M qdd - Q_v at orthonormal A, by central differences."""
    integrals = shape_integrals(body)
    n = body.n_modes
    A, _, eta, etad = random_state(n, 5)
    spin = np.array([[0.0, -0.7, 0.4], [0.7, 0.0, -1.1], [-0.4, 1.1, 0.0]])
    Ad = A @ spin
    q, qd = np.concatenate([np.zeros(3), A.T.ravel(), eta]), np.concatenate([[1.0, 2.0, -0.5], Ad.T.ravel(), etad])

    def energy(q: np.ndarray) -> float:
        b = body.mass_positions + body.mass_shapes @ q[12:]
        v = qd[:3] + b @ qd[3:12].reshape(3, 3) + (body.mass_shapes @ qd[12:]) @ q[3:12].reshape(3, 3)
        return float(0.5 * body.masses @ np.einsum("ij,ij->i", v, v))

    def momentum(q: np.ndarray) -> np.ndarray:
        B = literal_B(body, q[3:12].reshape(3, 3).T, q[12:])
        return np.asarray(B.T @ (np.repeat(body.masses, 3) * (B @ qd)))

    h = 1e-5
    rate = (momentum(q + h * qd) - momentum(q - h * qd)) / (2 * h)
    slope = np.array([(energy(q + h * e) - energy(q - h * e)) / (2 * h) for e in np.eye(12 + n)])
    found = integrals.velocity_force(A, Ad, eta, etad)
    np.testing.assert_allclose(found, slope - rate, atol=DIFFERENCES * np.abs(found).max())
    M = integrals.mass_matrix(A, eta)
    assert energy(q) == pytest.approx(0.5 * qd @ M @ qd, rel=1e-11)


def test_gravity_force_is_the_slope_of_the_potential(body: ReducedBody) -> None:
    integrals = shape_integrals(body)
    A, _, eta, _ = random_state(body.n_modes, 7)
    q = np.concatenate([[0.1, 0.2, 0.3], A.T.ravel(), eta])

    def work(q: np.ndarray) -> float:
        r = q[:3] + (body.mass_positions + body.mass_shapes @ q[12:]) @ q[3:12].reshape(3, 3)
        return float(body.masses @ r @ GRAVITY)

    h = 1e-4
    slope = np.array([(work(q + h * e) - work(q - h * e)) / (2 * h) for e in np.eye(q.size)])
    found = integrals.gravity_force(A, eta, GRAVITY)
    np.testing.assert_allclose(found, slope, atol=1e-8 * np.abs(found).max())


def test_integrals_have_their_symmetries_and_the_modal_mass(body: ReducedBody) -> None:
    s = shape_integrals(body)
    assert isinstance(s, ShapeIntegrals)
    n = body.n_modes
    assert (s.P.shape, s.c.shape, s.T.shape) == ((3, n), (3, n, 3), (n, n, 3, 3))
    np.testing.assert_allclose(s.modal_mass(), body.M, atol=ROUND_OFF * np.abs(body.M).max())
    np.testing.assert_array_equal(s.T, s.T.transpose(1, 0, 3, 2))
    assert s.mass == pytest.approx(body.masses.sum())
    j, l = 2, 5
    literal = np.einsum("k,ki,kj->ij", body.masses, body.mass_shapes[:, :, l], body.mass_shapes[:, :, j])
    np.testing.assert_allclose(s.T[j, l], literal, atol=1e-13)
    np.testing.assert_allclose(
        s.c[1, j], (body.masses * body.mass_positions[:, 1]) @ body.mass_shapes[:, :, j], atol=1e-13
    )
