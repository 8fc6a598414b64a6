"""Section forces, stresses, gauges and inertia relief against beam theory."""

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.sparse.linalg import spsolve

from mbs.flexible.component_modes import craig_bampton
from mbs.flexible.frame import Beam, Frame
from mbs.flexible.recovery import (
    StrainGauge,
    end_forces,
    fibre_stresses,
    gauge_rows,
    peak_tube_stress,
    section_force_field,
    section_forces,
    stress_field,
)
from mbs.flexible.relief_solution import inertia_relief
from mbs.flexible.section import rectangle
from tests.flexible.structures import STEEL, TUBE, portal, straight

ROUND_OFF = 1e-8


def clamped(frame: Frame, tip: int, load: np.ndarray) -> np.ndarray:
    """Displacements of a frame clamped at node 0 under a force and moment (6,) at node `tip`; no accelerations."""
    K = frame.finite_element_model().K
    F = np.zeros(K.shape[0])
    F[6 * tip : 6 * tip + 6] = load
    return at_rest(np.concatenate([np.zeros(6), spsolve(sp.csc_matrix(K[6:][:, 6:]), F[6:])]))


def at_rest(u: np.ndarray) -> np.ndarray:
    """With the accelerations of the nodes, which are 0."""
    return np.concatenate([u, np.zeros((len(u) // 2, *u.shape[1:]))])


@pytest.mark.parametrize("theory", ["euler_bernoulli", "timoshenko"])
def test_section_forces_of_a_cantilever_are_those_of_statics(theory: str) -> None:
    L, section = 1.2, rectangle(0.03, 0.05)
    frame = straight(3, L, section, theory)
    load = np.array([200.0, 30.0, -50.0, 7.0, 4.0, -3.0])
    u = clamped(frame, 3, load)
    for element, xi in ((0, 0.0), (1, 0.25), (2, 1.0)):
        arm = L - (element + xi) * L / 3
        moment = load[3:] + np.cross([arm, 0.0, 0.0], load[:3])
        np.testing.assert_allclose(
            section_forces(frame, element, xi) @ u, np.concatenate([load[:3], moment]), rtol=ROUND_OFF, atol=1e-6
        )


def test_a_load_downwards_stretches_the_upper_fibre_of_a_cantilever() -> None:
    L, section = 1.2, rectangle(0.03, 0.05)
    frame = straight(2, L, section)
    u = clamped(frame, 2, np.array([0.0, 0.0, -50.0, 0.0, 0.0, 0.0]))
    upper, lower = (fibre_stresses(frame, 0, 0.0) @ u)[:2]
    stress = 50.0 * L * 0.025 / section.Iy
    assert upper == pytest.approx(stress, rel=ROUND_OFF)
    assert lower == pytest.approx(-stress, rel=ROUND_OFF)
    gauge = StrainGauge("root", 0, 0.0)
    assert (gauge.bending_moment(frame) @ u)[0] == pytest.approx(50.0 * L, rel=ROUND_OFF)
    assert (gauge.half_bridge(frame) @ u)[0] == pytest.approx(2 * stress, rel=ROUND_OFF)


def test_a_push_to_the_left_presses_the_left_fibre() -> None:
    section = rectangle(0.03, 0.05)
    frame = straight(2, 1.0, section)
    u = clamped(frame, 2, np.array([0.0, 40.0, 0.0, 0.0, 0.0, 0.0]))
    (left_stress,) = fibre_stresses(frame, 0, 0.0, np.array([[0.015, 0.0]])) @ u
    assert left_stress == pytest.approx(-40.0 * 1.0 * 0.015 / section.Iz, rel=ROUND_OFF)


def test_half_bridge_does_not_see_pull_twist_or_sideways_bending() -> None:
    frame = straight(2, 1.0)
    rows = StrainGauge("middle", 1).half_bridge(frame)
    seen = abs((rows @ clamped(frame, 2, np.array([0.0, 0.0, 50.0, 0.0, 0.0, 0.0])))[0])
    blind = abs((rows @ clamped(frame, 2, np.array([50.0, 50.0, 0.0, 5.0, 0.0, 5.0])))[0])
    assert blind < 1e-8 * seen


def test_ends_of_every_element_are_in_balance_and_rigid_motions_stress_nothing() -> None:
    frame = portal()
    u = np.random.default_rng(3).normal(size=54) * 1e-3
    R = frame.finite_element_model().rigid_motions()
    for e in range(len(frame.beams)):
        f = end_forces(frame, e) @ u[frame.element_freedoms(e)]
        length = frame.element_axes(e)[0]
        np.testing.assert_allclose(f[:3] + f[6:9], 0.0, atol=1e-6 * np.abs(f).max())
        np.testing.assert_allclose(f[3:6] + f[9:] + np.cross([length, 0, 0], f[6:9]), 0.0, atol=1e-6 * np.abs(f).max())
    rows, _ = stress_field(frame)
    assert np.abs(rows @ at_rest(R)).max() < 1e-6 * np.abs(rows.data).max()


def test_stress_field_is_one_constant_matrix_on_the_amplitudes() -> None:
    frame = portal()
    body = craig_bampton(frame.finite_element_model("lumped"), "N0", ["N3", "N7"], 3)
    rows, where = stress_field(frame)
    assert rows.shape == (13 * 2 * 8, 54 + 27)
    matrix = body.recovery(rows)
    eta = np.random.default_rng(4).normal(size=body.n_modes) * 1e-3
    stress = matrix @ eta
    u = at_rest(body.modes @ eta)
    for point in (0, 57, 207):
        e, end, fibre = where[point]
        assert stress[point] == pytest.approx((fibre_stresses(frame, e, float(end)) @ u)[fibre], rel=1e-9)
    # round the section the largest of eight fibres lies within cos 22.5 degrees of the peak
    peak = peak_tube_stress(frame, section_force_field(frame) @ u)
    eight = np.abs(stress).reshape(13, 2, 8).max(axis=2)
    assert (eight <= peak * (1 + 1e-9)).all()
    assert (eight >= np.cos(np.pi / 8) * peak * (1 - 1e-9)).all()


def test_a_free_beam_pushed_in_the_middle_bends_like_one_under_its_own_inertia() -> None:
    """Closed form: free beam, force F at the middle, uniform inertia F/L: moment F L/8 at the middle."""
    L, n, F = 2.0, 40, 300.0
    frame = straight(n, L)
    model = frame.finite_element_model()
    rows, _ = gauge_rows(frame, (StrainGauge("middle", n // 2 - 1, 1.0), StrainGauge("quarter", n // 4 - 1, 1.0)))
    relief = inertia_relief(model, 0, [n // 2], rows)
    # pushed up in the middle the ends lag: the upper fibres are stretched
    middle, quarter = relief.balanced @ [0.0, 0.0, F]
    assert middle == pytest.approx(F * L / 8, rel=2e-3)
    assert quarter == pytest.approx(F / L * (L / 4) ** 2 / 2, rel=5e-3)
    mass = STEEL.rho * TUBE.area * L
    np.testing.assert_allclose(
        relief.acceleration_of_forces @ [0.0, 0.0, F], [0, 0, F / mass, 0, 0, 0], atol=1e-6 * F / mass
    )


def test_relief_from_forces_and_motion_is_relief_from_balanced_forces() -> None:
    frame = portal()
    model = frame.finite_element_model()
    rows = section_force_field(frame)
    relief = inertia_relief(model, "N0", ["N3", "N7"], rows)
    forces = np.array([10.0, -20.0, 30.0, 5.0, 2.0, -8.0])
    s, alpha = np.split(relief.acceleration_of_forces @ forces, 2)
    W = np.cross(alpha, np.eye(3)).T
    np.testing.assert_allclose(relief.outputs(forces, s, W), relief.balanced @ forces, atol=1e-7)
    # which node is held does not matter
    other = inertia_relief(model, "N5", ["N3", "N7"], rows)
    np.testing.assert_allclose(other.balanced @ forces, relief.balanced @ forces, atol=1e-6)


def test_a_beam_that_stands_upright_has_its_z_forward() -> None:
    frame = Frame([(0, 0, 0), (0, 0, 1.0)], [Beam(0, 1, TUBE, STEEL)])
    R = frame.element_axes(0)[1]
    np.testing.assert_allclose(R, [[0, 0, 1], [0, -1, 0], [1, 0, 0]], atol=1e-15)


@pytest.mark.parametrize("theory", ["euler_bernoulli", "timoshenko"])
@pytest.mark.parametrize("mass", ["consistent", "lumped"])
def test_a_cantilever_under_its_own_weight_has_the_moments_of_statics_with_few_elements(mass: str, theory: str) -> None:
    """Closed form: shear q (L - x) and moment q (L - x)2 / 2; between nodes where the mass is along the beam."""
    L, n, g = 1.2, 3, np.array([0.4, -2.0, -9.5])
    frame = straight(n, L, rectangle(0.03, 0.05), theory)
    model = frame.finite_element_model(mass)
    body = craig_bampton(model, 0, [], 0, inertia_modes=True)
    weight = model.mass_matrix() @ model.rigid_motions()[:, :3] @ g
    eta = np.linalg.solve(body.K, body.modes.T @ weight)
    relief = inertia_relief(model, 0, [], section_force_field(frame))
    field = body.recovery(section_force_field(frame)) @ eta
    np.testing.assert_allclose(
        relief.outputs(np.zeros(0), -g, np.zeros((3, 3))), field, atol=1e-6 * np.abs(field).max()
    )
    q = STEEL.rho * 0.03 * 0.05 * g
    for element, xi in ((0, 0.0), (1, 0.0), (1, 0.4), (2, 1.0)):
        rest = L - (element + xi) * L / n
        exact = np.array([q[0] * rest, q[1] * rest, q[2] * rest, 0.0, -q[2] * rest**2 / 2, q[1] * rest**2 / 2])
        if mass == "lumped":  # at the nodes there is what they carry, and half of a beam less
            if xi != 0.0:
                continue
            exact[:3] -= q * L / n / 2
        actual = body.recovery(section_forces(frame, element, xi)) @ eta
        np.testing.assert_allclose(actual, exact, rtol=1e-6, atol=1e-6 * abs(q[2]) * L)


def test_a_pendulum_of_few_elements_has_the_stress_of_its_inertia() -> None:
    """Closed form of a rod that turns about one end: the pull q w2 (L2 - x2) / 2 of rows on W, at and between nodes."""
    L, n, w = 1.0, 3, 20.0
    frame = straight(n, L)
    model = frame.finite_element_model()
    spin = np.array([[0.0, -w, 0.0], [w, 0.0, 0.0], [0.0, 0.0, 0.0]])
    for element, xi in ((0, 0.0), (1, 0.5), (2, 0.0)):
        x = (element + xi) * L / n
        pull = inertia_relief(model, 0, [], section_forces(frame, element, xi)[[0]]).outputs(
            np.zeros(0), np.zeros(3), spin @ spin
        )
        assert pull[0] == pytest.approx(STEEL.rho * TUBE.area * w**2 * (L**2 - x**2) / 2, rel=1e-6)
