"""Rows, tangent and factorization against dense NumPy and finite differences."""

import numpy as np
import pytest

from mbs.kernel.binding import LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.kernel.header.enumerations import ElementType
from mbs.settings.settings import Settings

from .scenes import everything, four_bar
from .system_builder import Element, Row, SystemBuilder, distance_row

SEED = 11
DIFFERENCE = 1e-6
FD_TOLERANCE = 2e-8  # of central differences with that step


def initialised(builder: SystemBuilder) -> Instance:
    instance = Instance(LoadedSystem(builder.to_bytes()))
    instance.initialise(0.4)
    return instance


def driving_values(t: float) -> np.ndarray:
    """The driving functions of `everything` with input 0 at rest: filtered input, then 10 t^3 - 15 t^4 + 6 t^5."""
    return np.array([0.0, 10 * t**3 - 15 * t**4 + 6 * t**5])


def dense_jacobian(builder: SystemBuilder, values: np.ndarray) -> np.ndarray:
    arrays = builder.arrays()
    ptr, col = np.array(arrays["row_ptr"]), np.array(arrays["row_col"])
    J = np.zeros((len(ptr) - 1, len(builder.q0)))
    for k in range(len(J)):
        J[k, col[ptr[k] : ptr[k + 1]]] = values[ptr[k] : ptr[k + 1]]
    return J


def test_rows_are_the_polynomials_they_were_made_of():
    b = everything()
    instance = initialised(b)
    scale = np.array(b.arrays()["row_scale"])
    rng = np.random.default_rng(SEED)
    for t in (0.0, 0.3, 0.9, 1.7):
        q = b.q0 + rng.normal(size=5)
        s = driving_values(t) if t < 1.0 else np.array([0.0, 1.0])
        phi = np.array(instance.evaluate(q, np.zeros(5), None, t)["phi"])
        np.testing.assert_allclose(phi, scale * [b.value(row, q, s) for row in b.rows], rtol=1e-12, atol=1e-13)


def test_jacobian_and_rates_agree_with_differences():
    b = everything()
    instance = initialised(b)
    rng = np.random.default_rng(SEED + 1)
    for t in (0.2, 0.5, 0.8):
        q, qd = b.q0 + 0.5 * rng.normal(size=5), rng.normal(size=5)
        now = {k: np.array(v) for k, v in instance.evaluate(q, qd, None, t).items()}
        J = dense_jacobian(b, now["jacobian"])

        def phi(x: np.ndarray, at: float) -> np.ndarray:
            return np.array(instance.evaluate(x, qd, None, at)["phi"])  # noqa: B023

        def rate(at: float) -> np.ndarray:
            x = q + (at - t) * qd  # noqa: B023
            v = instance.evaluate(x, qd, None, at)  # noqa: B023
            return dense_jacobian(b, np.array(v["jacobian"])) @ qd + np.array(v["phi_t"])  # noqa: B023

        d = DIFFERENCE
        for i, e in enumerate(d * np.eye(5)):
            np.testing.assert_allclose(J[:, i], (phi(q + e, t) - phi(q - e, t)) / (2 * d), atol=FD_TOLERANCE)
        np.testing.assert_allclose(now["phi_t"], (phi(q, t + d) - phi(q, t - d)) / (2 * d), atol=FD_TOLERANCE)
        np.testing.assert_allclose(now["gamma"], (rate(t + d) - rate(t - d)) / (2 * d), atol=FD_TOLERANCE)
        assert abs(now["phi_t"]).max() > 1e-3


def crossed() -> SystemBuilder:
    """The same with a spring between coordinates that do not stand side by side, two of them in both its signals."""
    b = everything()
    b.signals[1] = ({0: 0.3, 2: -0.4, 4: 0.7}, 0.5)
    return b


@pytest.mark.parametrize("scene", [everything, crossed])
@pytest.mark.parametrize("groups", [[5], [2, 1, 2]])
@pytest.mark.parametrize("geometric", [0, 1])
def test_the_tangent_is_the_derivative_of_the_residual(scene, groups, geometric):
    """df/dq of (22) at fixed multipliers: M + c alpha Phi_q' Phi_q + c sum lam_k H_k - c dQ/dq - h/2 dQ/dqd."""
    b = scene()
    b.groups = groups
    instance = initialised(b)
    instance.set_settings(geometric=geometric)
    h, lam = 0.01, np.array([30.0, -20.0, 50.0])
    c, alpha, d = h * h / 4, 1 / (instance.settings()["eps_rel"] * h * h), DIFFERENCE
    q, qd = (np.array(v) for v in instance.get_state()[:2])

    def at(x: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        values = instance.evaluate(x, v, None, instance.time)
        return dense_jacobian(b, np.array(values["jacobian"])), np.array(values["force"])

    J, _ = at(q, qd)
    expected = b.mass + c * alpha * J.T @ J
    for i, e in enumerate(d * np.eye(5)):
        (J1, Q1), (J0, Q0) = at(q + e, qd), at(q - e, qd)
        expected[:, i] += c * geometric * (J1 - J0).T @ lam / (2 * d) - c * (Q1 - Q0) / (2 * d)
        expected[:, i] -= h / 2 * (at(q, qd + e)[1] - at(q, qd - e)[1]) / (2 * d)
    tangent = np.reshape(instance.tangent(h, lam), (5, 5))
    assert (tangent == tangent.T).all()
    expected = 0.5 * (expected + expected.T)  # a damper in motion has an unsymmetric part, which is left out
    penalty = c * alpha * J.T @ J
    np.testing.assert_allclose(tangent - penalty, expected - penalty, atol=1e-6)


def test_a_row_of_nearly_all_coordinates_of_a_front_is_in_its_tangent():
    """M + c alpha J' J, of linear rows: two with nine and ten of ten coordinates, one with two."""
    rng, n, h = np.random.default_rng(SEED + 5), 10, 0.01
    rows = [Row(0.0, {int(i): float(rng.normal()) for i in which}) for which in (range(n), range(1, n), (2, 7))]
    b = SystemBuilder(np.diag(rng.uniform(1.0, 2.0, n)), np.zeros(n), rows=rows)
    instance = initialised(b)
    J = dense_jacobian(b, np.array(instance.evaluate(b.q0, b.q0, None, 0.0)["jacobian"]))
    expected = b.mass + 0.25 / instance.settings()["eps_rel"] * J.T @ J
    np.testing.assert_allclose(np.reshape(instance.tangent(h, np.zeros(3)), (n, n)), expected, rtol=1e-12)


def turning_pair() -> SystemBuilder:
    """Two planar vectors a, b and the angle from a to b: cos(theta) a x b - sin(theta) a . b = 0."""
    b = SystemBuilder(
        np.diag([1.0, 2.0, 1.5, 0.7, 0.3]),
        [0.9, -0.4, 0.2, 1.1, 1.8],
        rows=[Row(0.0, theta=4, angle=[(2, 0, 1.0, 0.0), (3, 1, 1.0, 0.0), (3, 0, 0.0, 1.0), (2, 1, 0.0, -1.0)])],
    )
    b.sensors = [(10, [3], [])]
    return b


def test_an_angle_between_two_moving_vectors_has_all_its_derivatives():
    b = turning_pair()
    instance = initialised(b)
    rng = np.random.default_rng(SEED + 2)
    d, h, lam = DIFFERENCE, 0.01, np.array([40.0])
    for _ in range(5):
        q, qd = b.q0 + 0.5 * rng.normal(size=5), rng.normal(size=5)
        now = {k: np.array(v) for k, v in instance.evaluate(q, qd, None, 0.0).items()}

        def jacobian(x: np.ndarray) -> np.ndarray:
            return np.array(instance.evaluate(x, qd, None, 0.0)["jacobian"])  # noqa: B023

        phi = [
            float(b.row_scale(b.rows[0]) * b.value(b.rows[0], q + s * d * e)) for e in np.eye(5) for s in (1.0, -1.0)
        ]
        np.testing.assert_allclose(now["jacobian"], np.subtract(phi[::2], phi[1::2]) / (2 * d), atol=FD_TOLERANCE)
        drift = (jacobian(q + d * qd) - jacobian(q - d * qd)) @ qd / (2 * d)
        np.testing.assert_allclose(now["gamma"], [drift], atol=FD_TOLERANCE)
    q, c = (
        b.q0 + 0.5 * rng.normal(size=5),
        h * h / 4,
    )  # where the row is open, its own value is in the second derivative
    assert abs(b.value(b.rows[0], q)) > 0.1
    instance.set_q(q)
    second = np.array([(jacobian(q + d * e) - jacobian(q - d * e)) / (2 * d) for e in np.eye(5)])
    plain = np.reshape(instance.tangent(h, np.zeros(1)), (5, 5))
    actual = (np.reshape(instance.tangent(h, lam), (5, 5)) - plain) / (c * lam[0])
    np.testing.assert_allclose(actual, second, atol=1e-3)  # beside the penalty, 1e7 times as large


def chain(n: int, groups: list[int]) -> SystemBuilder:
    """A hanging chain of n points and springs to the ground that slant: every front passes something on."""
    rows = [distance_row((0.0, 0.0), (0, 1), 1.0, True)]
    rows += [distance_row((2 * i, 2 * i + 1), (2 * i + 2, 2 * i + 3), 1.0, False) for i in range(n - 1)]
    angle = 0.4 + 0.13 * np.arange(n)
    q0 = np.column_stack([np.cumsum(np.sin(angle)), -np.cumsum(np.cos(angle))]).ravel()
    mass = np.diag(1.0 + 0.1 * np.arange(2 * n))
    gravity = -9.81 * np.diag(mass) * np.tile([0.0, 1.0], n)
    b = SystemBuilder(mass, q0, None, gravity, rows, groups)
    signals = [b.signal({2 * n - 2: 1.0}, 0.5), b.signal({2 * n - 1: 1.0}, -0.5)]
    b.elements = [Element(1, signals, [300.0, 8.0, 1.0, 1.0, 1.0, 0.0, 0.0, 1e9, 0.0], outputs=4)]
    return b


def woven(n: int, groups: list[int]) -> SystemBuilder:
    """The same with springs between points far apart: what a front passes on does not lie side by side in the next."""
    b = chain(n, groups)
    for ends in ((0, 11), (1, 7, 10), (2, 6, 9), (3, 8), (4, 11)):
        signal = b.signal({i: 0.3 + 0.1 * i for i in ends}, 0.2)
        b.elements.append(Element(1, [signal, signal], [300.0, 8.0, 1.0, 1.0, 1.0, 0.0, 0.0, 1e9, 0.0], outputs=4))
    return b


@pytest.mark.parametrize("scene", [chain, woven])
@pytest.mark.parametrize("groups", [[4, 4, 4], [1] * 12, [3, 1, 5, 3]], ids=str)
def test_fronts_solve_as_one_dense_front_does(scene, groups):
    """Thirty steps do not depend on how the coordinates are cut into fronts; the tangent is positive definite."""
    b = scene(6, groups)
    instance = initialised(b)
    reference = initialised(scene(6, [12]))
    for i in (instance, reference):
        i.set_settings(tolerance_r=1e-13, tolerance_phi=1e-12)
    for _ in range(30):
        instance.step(0.01)
        reference.step(0.01)
    np.testing.assert_allclose(instance.get_state()[0], reference.get_state()[0], atol=1e-7)
    tangent = np.reshape(instance.tangent(0.01), (12, 12))
    np.testing.assert_allclose(tangent, np.reshape(reference.tangent(0.01), (12, 12)), rtol=1e-6, atol=1.0)
    assert np.linalg.eigvalsh(tangent).min() > 0


def net(order: np.ndarray, groups: list[int]) -> SystemBuilder:
    """Six points in space that hang in springs on combinations of them, and a coordinate beside; in any order."""
    n = 19
    place = np.argsort(order)
    rng = np.random.default_rng(SEED + 7)
    of_points = rng.normal(size=(6, 6)) / 4
    mass = np.zeros((n, n))
    mass[:18, :18] = np.kron(of_points @ of_points.T + np.eye(6), np.eye(3))
    mass[18, 18] = mass[0, 18] = mass[18, 0] = 0.7
    q0 = np.append(rng.normal(size=18), 0.3)
    points = [tuple(int(place[3 * k + i]) for i in range(3)) for k in range(6)]
    rows = [
        distance_row(
            points[k], points[k + 1], float(np.linalg.norm(q0[3 * k + 3 : 3 * k + 6] - q0[3 * k : 3 * k + 3])), False
        )
        for k in (0, 2, 4)
    ]  # type: ignore[arg-type]
    b = SystemBuilder(
        mass[np.ix_(order, order)], q0[order], None, -9.81 * np.tile([0, 0, 1.0], 7)[:n][order], rows, groups
    )
    for share in rng.normal(size=(5, 6)) * (rng.random((5, 6)) < 0.6) + np.eye(5, 6):
        signals = [
            b.signal({p[i]: s for p, s in zip(points, share, strict=True) if s != 0.0}, 0.2 * i) for i in range(3)
        ]
        b.elements.append(Element(1, signals, [300.0, 8.0, 1.0, 1.0, 1.0, 0.0, 0.0, 1e9, 0.0], outputs=4))
    b.elements.append(
        Element(
            1,
            [b.signal({int(place[18]): 1.0, points[5][2]: 0.5}), b.signal({points[0][0]: 1.0}, 0.4)],
            [90.0, 3.0, 0.1, 1.0, 1.0, 0.0, 0.0, 1e9, 0.0],
            outputs=4,
        )
    )
    return b


@pytest.mark.parametrize("groups", [[19], [3, 3, 13]], ids=str)
def test_components_of_points_in_turn_give_what_they_give_in_any_order(groups):
    """Mass matrix, signals, forces, their tangent and rows take x, y and z together where they follow each other."""
    turned = np.array([18, *(np.arange(18).reshape(6, 3)[:, ::-1].T.ravel())])
    ends, tangents = [], []
    for order in (np.arange(19), turned):
        b = net(order, groups)
        instance = initialised(b)
        instance.set_settings(tolerance_r=1e-13, tolerance_phi=1e-12)
        tangents.append(np.reshape(instance.tangent(0.01), (19, 19))[np.ix_(np.argsort(order), np.argsort(order))])
        for _ in range(30):
            instance.step(0.01)
        ends.append(np.array(instance.get_state()[0])[np.argsort(order)])
    assert np.abs(ends[0] - net(np.arange(19), groups).q0).max() > 0.05
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-10)
    np.testing.assert_allclose(tangents[0], tangents[1], rtol=1e-9, atol=1e-9 * np.abs(tangents[0]).max())


@pytest.mark.parametrize("method", ["energy_momentum", "radau_5"])
@pytest.mark.parametrize("groups", [[4, 4, 4], [3, 1, 5, 3]], ids=str)
def test_fronts_without_symmetry_solve_as_one_dense_front_does(groups, method):
    ends = []
    for cut in (groups, [12]):
        instance = initialised(chain(6, cut))
        settings = Settings(method=method, tolerance_r=1e-13, tolerance_phi=1e-12)
        instance.set_settings(**settings.kernel_fields())  # type: ignore[arg-type]
        for _ in range(10):
            instance.step(0.01)
        report = instance.report()
        ends.append((np.array(instance.get_state()[0]), report["iterations"], report["halvings"]))
    np.testing.assert_allclose(ends[0][0], ends[1][0], atol=1e-9)
    assert ends[0][1] == ends[1][1]  # a wrong tangent would cost iterations
    assert ends[0][2] == ends[1][2] == 0


def test_accelerations_and_multipliers_at_the_start_solve_the_index_one_equations():
    b = chain(6, [4, 4, 4])
    b.qd0 = np.random.default_rng(SEED + 2).normal(size=12)
    instance = initialised(b)
    q, qd, qdd, lam, _ = (np.array(v) for v in instance.get_state())
    values = {k: np.array(v) for k, v in instance.evaluate(q, qd).items()}
    J = dense_jacobian(b, values["jacobian"])
    K = np.block([[b.mass, J.T], [J, np.zeros((6, 6))]])
    exact = np.linalg.solve(K, np.concatenate([values["force"], -values["gamma"]]))
    np.testing.assert_allclose(qdd, exact[:12], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(lam, exact[12:], rtol=1e-9, atol=1e-7)
    np.testing.assert_allclose(J @ qd, 0.0, atol=1e-11)


@pytest.mark.parametrize(
    ("signals", "columns"),
    [
        *(([0, 1, 2], [0, *columns]) for columns in ([1, 2, 3], [3, 2, 1], [1, 3, 2])),
        *((signals, [0, 1, 2, 3]) for signals in ([0, 3, 2], [2, 1, 0], [0, 1, 3])),
    ],
)
def test_a_spring_acts_on_its_own_signals_in_any_order(signals, columns):
    """Three signals go together where their numbers and columns follow each other, and only there."""
    q, stiffness, free = np.array([1.0, 2.0, 3.0, 5.0]), 10.0, 1.0
    b = SystemBuilder(np.eye(4), q)
    for column in columns:
        b.signal({column: 1.0})
    b.elements = [
        Element(ElementType.SPRING_DAMPER, signals, [stiffness, 0.0, free, 1.0, 1.0, 0.0, 0.0, 1e9, 0.0], outputs=4)
    ]
    instance = Instance(LoadedSystem(b.to_bytes()))
    own = np.isin(np.arange(4), np.array(columns)[signals])
    length = np.linalg.norm(q[own])
    n = np.where(own, q / length, 0.0)
    np.testing.assert_allclose(instance.evaluate(q, 0.0 * q)["force"], -stiffness * (length - free) * n, rtol=1e-14)
    slack = 1.0 - free / length
    hessian = stiffness * (slack * np.diag(own) + (1.0 - slack) * np.outer(n, n))
    instance.initialise(0.0)
    h = 0.1
    tangent = np.array(instance.tangent(h)).reshape(4, 4)
    np.testing.assert_allclose(tangent, np.eye(4) + 0.25 * h**2 * hessian, rtol=1e-13, atol=1e-15)


def test_accelerations_exist_on_the_singular_position():
    """Cranks horizontal: five rows of rank three; the start must still find M qdd + Phi_q' lam = Q."""
    b = four_bar()
    b.q0 = np.array([1.0, 0.0, 2.0, 0.0, 3.0, 0.0])
    b.qd0 = np.tile([0.0, -1.0], 3)
    instance = initialised(b)
    q, qd, qdd, lam, _ = (np.array(v) for v in instance.get_state())
    values = {k: np.array(v) for k, v in instance.evaluate(q, qd).items()}
    J = dense_jacobian(b, values["jacobian"])
    assert np.linalg.matrix_rank(J) == 3
    np.testing.assert_allclose(b.mass @ qdd + J.T @ lam, values["force"], atol=1e-9)
    np.testing.assert_allclose(J @ qdd + values["gamma"], 0.0, atol=1e-9)
