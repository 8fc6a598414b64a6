"""M(q), Q_v, weight and energies of the kernel against the literal sums of the paper's equations (5) to (14)."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mbs import compile
from mbs.model import Model
from mbs.simulation.evaluator import Evaluator
from mbs.simulation.stepping import Simulation
from tests.flexible_engine.bodies import cloud

ROUND_OFF = 1e-13
GRAVITY = np.array([1.0, -2.0, -9.0])
AXES = Rotation.from_euler("xyz", (0.3, -0.5, 0.7)).as_matrix()


class Literal:
    """One free body, B and its rate as equation (10) writes them; coordinates in the order of the model."""

    def __init__(self) -> None:
        self.reduced = cloud()
        m = Model("cloud", gravity=GRAVITY)
        self.body = m.flexible_body("cloud", self.reduced, origin=(1.0, 2.0, 3.0), axes=AXES)
        for kind in ("kinetic", "gravity", "elastic", "total"):
            m.sense_energy(kind, kind)
        self.simulation = Simulation(compile(m))
        names = [c.name for c in m.coordinates]
        # place[i]: where full coordinate i is in the System
        self.place = np.array([self.simulation.system.meta["coordinates"].index(n) for n in names])
        # along the axes of the drawing
        self.x = self.reduced.mass_positions @ AXES.T
        self.phi = np.einsum("ik,pkj->pij", AXES, self.reduced.mass_shapes)
        self.masses = np.repeat(self.reduced.masses, 3)

    def state(self, seed: int) -> tuple[np.ndarray, np.ndarray]:
        """A random position and velocity with orthonormal axes."""
        rng = np.random.default_rng(seed)
        A = Rotation.random(random_state=seed).as_matrix()
        Ad = np.cross(rng.normal(size=3), A.T).T
        n = self.reduced.n_modes
        q = np.concatenate([rng.normal(size=3), A.T.ravel(), 0.3 * rng.normal(size=n)])
        qd = np.concatenate([rng.normal(size=3), Ad.T.ravel(), rng.normal(size=n)])
        return q, qd

    def B(self, q: np.ndarray) -> np.ndarray:
        """Equation (10), shape (3 p, 12 + n)."""
        A, eta = q[3:12].reshape(3, 3).T, q[12:]
        local = self.x + self.phi @ eta
        axes = np.einsum("pi,kl->pkil", local, np.eye(3)).reshape(-1, 9)
        first = np.tile(np.eye(3), (len(local), 1))
        modes = np.einsum("kl,plj->pkj", A, self.phi).reshape(-1, len(eta))
        return np.hstack([first, axes, modes])

    def positions(self, q: np.ndarray) -> np.ndarray:
        """Mass points in the earth, shape (3 p,)."""
        return (q[:3] + (self.x + self.phi @ q[12:]) @ q[3:12].reshape(3, 3)).ravel()

    def put(self, full: np.ndarray) -> list[float]:
        """In the order of the System."""
        z = np.empty(len(full))
        z[self.place] = full
        return z.tolist()

    def mass(self, q: np.ndarray) -> np.ndarray:
        """M(q) of the kernel in the order of the model."""
        n = len(q)
        dense = np.reshape(self.simulation.instance.mass_matrix(self.put(q)), (n, n))
        return dense[np.ix_(self.place, self.place)]

    def force(self, q: np.ndarray, qd: np.ndarray) -> np.ndarray:
        """Q of the kernel in the order of the model."""
        values = self.simulation.instance.evaluate(self.put(q), self.put(qd))["force"]
        return np.array(values)[self.place]


@pytest.fixture(scope="module")
def body() -> Literal:
    return Literal()


@pytest.mark.parametrize("seed", range(2))
def test_mass_matrix_is_the_literal_product(body: Literal, seed: int) -> None:
    q, _ = body.state(seed)
    B = body.B(q)
    expected = B.T @ (body.masses[:, None] * B)
    assert np.max(np.abs(body.mass(q) - expected)) < ROUND_OFF * np.max(np.abs(expected))


@pytest.mark.parametrize("seed", range(2))
def test_velocity_forces_are_the_literal_product(body: Literal, seed: int) -> None:
    q, qd = body.state(seed)
    Bd = (body.B(q + 0.5 * qd) - body.B(q - 0.5 * qd)) @ qd  # B is linear in q
    expected = -body.B(q).T @ (body.masses * Bd)
    damping = np.concatenate([np.zeros(12), body.reduced.C @ qd[12:]])
    result = body.force(q, qd) - body.force(q, 0.0 * qd) + damping
    assert np.linalg.norm(expected) > 1.0
    assert np.max(np.abs(result - expected)) < ROUND_OFF * 10 * np.max(np.abs(expected))


@pytest.mark.parametrize("seed", range(2))
def test_forces_are_those_of_lagrange(body: Literal, seed: int) -> None:
    """``d/dt (dT/dqd) - dT/dq`` with differences of the energies: the velocities of mass points are consistent with
    their positions, so that nothing is lost against the interpolation of equation (4).
    """
    q, qd = body.state(seed)
    h = 1e-4

    def kinetic(x: np.ndarray) -> float:
        return float(0.5 * np.sum(body.masses * (body.B(x) @ qd) ** 2))

    def potential(x: np.ndarray) -> float:
        height = body.positions(x).reshape(-1, 3) @ GRAVITY
        return float(-np.sum(body.reduced.masses * height) + 0.5 * x[12:] @ body.reduced.K @ x[12:])

    e = h * np.eye(len(q))
    slope = np.array([kinetic(q + d) - kinetic(q - d) - potential(q + d) + potential(q - d) for d in e]) / (2 * h)
    momentum_rate = (
        (body.B(q + h * qd).T @ (body.masses * (body.B(q + h * qd) @ qd)))
        - (body.B(q - h * qd).T @ (body.masses * (body.B(q - h * qd) @ qd)))
    ) / (2 * h)
    expected = slope - momentum_rate - np.concatenate([np.zeros(12), body.reduced.C @ qd[12:]])
    # on the tangent of the frame conditions: A'A = 1 was used
    free = _tangent(q)
    result = body.force(q, qd)
    assert np.max(np.abs(free @ (result - expected))) < 1e-6 * np.max(np.abs(expected))


def _tangent(q: np.ndarray) -> np.ndarray:
    """Rows: velocities that keep the axes orthonormal."""
    n = len(q) - 12
    rows = np.zeros((6 + n, len(q)))
    rows[:3, :3], rows[6:, 12:] = np.eye(3), np.eye(n)
    A = q[3:12].reshape(3, 3)
    for k in range(3):
        rows[3 + k, 3:12] = np.cross(np.eye(3)[k], A).ravel()
    return rows


@pytest.mark.parametrize("seed", range(2))
def test_energies_are_sums_over_the_mass_points(body: Literal, seed: int) -> None:
    q, qd = body.state(seed)
    simulation = body.simulation
    simulation.instance.set_q(body.put(q), body.put(qd))
    simulation.instance.initialise(0.0)
    actual = simulation.sensors
    velocity = body.B(q) @ qd
    kinetic = 0.5 * np.sum(body.masses * velocity**2)
    gravity = -np.sum(body.reduced.masses * (body.positions(q).reshape(-1, 3) @ GRAVITY))
    elastic = 0.5 * q[12:] @ body.reduced.K @ q[12:]
    assert actual["kinetic"] == pytest.approx(kinetic, rel=1e-12)
    assert actual["gravity"] == pytest.approx(gravity, rel=1e-12)
    assert actual["elastic"] == pytest.approx(elastic, rel=1e-12)
    assert actual["total"] == pytest.approx(kinetic + gravity + elastic, rel=1e-12)


def test_tangent_carries_stiffness_damping_and_weight(body: Literal) -> None:
    q, qd = body.state(1)
    simulation, h = body.simulation, 1e-2
    simulation.instance.set_q(body.put(q), body.put(qd))
    simulation.instance.initialise(0.0)
    simulation.instance.set_settings(alpha=1e-12, geometric=0)
    n = len(q)
    dense = np.reshape(simulation.instance.tangent(h), (n, n))[np.ix_(body.place, body.place)]
    simulation.instance.set_settings(alpha=0.0, geometric=1)
    c = h * h / 4
    expected = body.mass(q)
    expected[12:, 12:] += 0.5 * h * body.reduced.C + c * body.reduced.K
    P = np.einsum("p,pij->ij", body.reduced.masses, body.phi)
    hang = -c * np.einsum("ij,k->ikj", P, GRAVITY).reshape(9, -1)
    expected[3:12, 12:] += hang
    expected[12:, 3:12] += hang.T
    assert np.max(np.abs(dense - expected)) < ROUND_OFF * np.max(np.abs(expected))


def test_rows_with_the_same_modes_are_squared_whole() -> None:
    """c alpha J' J of rods that hang at two points each; rows of a front do not follow each other."""
    m = Model("net")
    cloudy = m.flexible_body("cloud", cloud(9, 12))
    points = cloudy.node_positions
    rods = [
        m.body(f"rod {k}", mass=1.0, com=0.5 * (points[k] + points[k + 4]), inertia=np.diag((0.1, 0.12, 0.05)))
        for k in range(1, 5)
    ]
    for first in (1, 5):
        for k, rod in enumerate(rods):
            m.spherical(f"ball {first + k}", cloudy, rod, point=points[first + k])
    system = compile(m)
    rows, front = system.arrays["row_ptr"], np.array(system.arrays["row_front"])
    wide = front[np.diff(rows) > 12].tolist()
    assert wide[:3] == wide[12:15] != wide[3:6]
    simulation, n, h = Simulation(system), system.nq, 1e-2
    instance, J = simulation.instance, Evaluator(simulation).jacobian(simulation.state.q)
    tangents = []
    for alpha in (1e11, 3e11):
        instance.set_settings(alpha=alpha)
        tangents.append(np.reshape(instance.tangent(h), (n, n)))
    actual = (tangents[1] - tangents[0]) / (0.25 * h * h * 2e11)
    np.testing.assert_allclose(actual, J.T @ J, atol=1e-12 * np.max(np.abs(J.T @ J)))
