"""Beam elements against closed forms of beam theory."""

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.sparse.linalg import spsolve

from mbs.flexible.beam_mass import beam_mass_points, bending_functions
from mbs.flexible.fe_model import FiniteElementModel
from mbs.flexible.frequencies import natural_modes
from mbs.flexible.section import rectangle
from tests.flexible.structures import STEEL, TUBE, portal, straight

ROUND_OFF = 1e-9
EXACT = 1e-12
FINE_MESH = 1e-4  # third frequency with 20 consistent elements
CLAMPED = np.arange(6)
FREE_FREE = np.array([4.730040744863, 7.853204624096, 10.995607838002])  # roots of cos x cosh x = 1
CANTILEVER = np.array([1.875104068712, 4.694091132974, 7.854757438238])  # roots of cos x cosh x = -1


def deflection(model: FiniteElementModel, load: dict[int, float], fixed: np.ndarray = CLAMPED) -> np.ndarray:
    free = np.setdiff1d(np.arange(model.n_dof), fixed)
    F = np.zeros(model.n_dof)
    F[list(load)] = list(load.values())
    u = np.zeros(model.n_dof)
    u[free] = spsolve(sp.csc_matrix(model.K[free][:, free]), F[free])
    return u


@pytest.mark.parametrize("theory", ["euler_bernoulli", "timoshenko"])
@pytest.mark.parametrize("elements", [1, 5])
def test_clamped_beam_under_tip_loads_has_the_closed_form(theory, elements):
    L, E, G = 1.5, STEEL.E, STEEL.G
    section = rectangle(0.03, 0.05)
    model = straight(elements, L, section, theory).finite_element_model()
    tip = 6 * elements
    u = deflection(model, {tip: 1000.0, tip + 1: 50.0, tip + 2: 80.0, tip + 3: 10.0})[tip:]
    ky, kz = section.shear_factors(STEEL.nu) if theory == "timoshenko" else (np.inf, np.inf)
    expected = [
        1000.0 * L / (E * section.area),
        50.0 * L**3 / (3 * E * section.Iz) + 50.0 * L / (ky * G * section.area),
        80.0 * L**3 / (3 * E * section.Iy) + 80.0 * L / (kz * G * section.area),
        10.0 * L / (G * section.J),
        -80.0 * L**2 / (2 * E * section.Iy),
        50.0 * L**2 / (2 * E * section.Iz),
    ]
    np.testing.assert_allclose(u, expected, rtol=ROUND_OFF)


def test_a_beam_does_not_care_how_it_lies_in_space():
    tip_loads = np.array([30.0, -20.0, 50.0])
    along = straight(3).finite_element_model()
    energy = deflection(along, dict(zip(range(18, 21), tip_loads, strict=True)))[18:21] @ tip_loads
    for direction in ((0.0, 0.0, 1.0), (1.0, -2.0, 0.7), (0.0, 0.0, -1.0), (0.02, 0.0, 1.0)):
        frame = straight(3, direction=direction)
        R = frame.element_axes(0)[1]
        np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-14)
        assert np.linalg.det(R) == pytest.approx(1.0)
        turned = R.T @ tip_loads
        u = deflection(frame.finite_element_model(), dict(zip(range(18, 21), turned, strict=True)))
        assert u[18:21] @ turned == pytest.approx(energy, rel=ROUND_OFF)


@pytest.mark.parametrize(("held", "roots", "rigid"), [((3,), FREE_FREE, 5), (CLAMPED, CANTILEVER, 0)])
def test_tube_vibrates_at_the_frequencies_of_euler_and_bernoulli(held, roots, rigid):
    L = 1.5  # without rotary inertia the twist of the free tube has no mass: it is held
    model = straight(20, L).finite_element_model("consistent", rotary=False)
    hertz, _ = natural_modes(model, rigid + 6, held)
    expected = roots**2 / (2 * np.pi * L**2) * np.sqrt(STEEL.E * TUBE.Iy / (STEEL.rho * TUBE.area))
    if rigid:
        assert hertz[:5].max() < 1e-3 * hertz[5]
    np.testing.assert_allclose(hertz[rigid::2], expected, rtol=FINE_MESH)
    np.testing.assert_allclose(hertz[rigid + 1 :: 2], expected, rtol=FINE_MESH)


def test_twist_of_a_clamped_rod_is_a_wave_of_the_shear_modulus():
    L, n = 0.5, 40
    stubby = rectangle(0.05, 0.05)
    model = straight(n, L, stubby).finite_element_model()
    twist_only = np.setdiff1d(np.arange(model.n_dof), 6 * np.arange(1, n + 1) + 3)
    hertz, _ = natural_modes(model, 2, twist_only)
    polar = stubby.Iy + stubby.Iz
    wave = np.sqrt(STEEL.G * stubby.J / (STEEL.rho * polar))
    np.testing.assert_allclose(hertz, np.array([1.0, 3.0]) * wave / (4 * L), rtol=1e-3)


def test_frequencies_of_a_stubby_simply_supported_beam_follow_timoshenko():
    L, n = 0.5, 48
    section = rectangle(0.08, 0.08)
    model = straight(n, L, section, "timoshenko").finite_element_model()
    # both ends pinned in the x-z plane, everything out of it held
    plane = np.concatenate([6 * np.arange(n + 1) + axis for axis in (0, 1, 3, 5)])
    hertz, _ = natural_modes(model, 2, np.union1d(plane, [2, 6 * n + 2]))
    k = np.array([1.0, 2.0]) * np.pi / L
    I, A, kGA = section.Iy, section.area, section.shear_factors(STEEL.nu)[1] * STEEL.G * section.area
    # Timoshenko 1921: rho I/kGA w4 - (1 + k2 I/A + k2 E I/kGA) w2 + k4 E I/(rho A) = 0, for sin(k x)
    quadratic = [
        STEEL.rho * I / kGA,
        -(1 + k**2 * I / A + k**2 * STEEL.E * I / kGA),
        k**4 * STEEL.E * I / (STEEL.rho * A),
    ]
    a, b, c = quadratic
    expected = np.sqrt(2 * c / (-b + np.sqrt(b**2 - 4 * a * c))) / (2 * np.pi)
    np.testing.assert_allclose(hertz, expected, rtol=5e-4)
    bernoulli = np.sqrt(c) / (2 * np.pi)
    assert (bernoulli / expected > 1.04).all(), "the case must tell the theories apart"


def test_interpolation_solves_the_unloaded_beam():
    L, phi = 0.7, 0.8
    for theory_phi in (0.0, phi):
        start, slope = bending_functions(0.0, L, theory_phi)
        end, end_slope = bending_functions(1.0, L, theory_phi)
        np.testing.assert_allclose(np.array([start, slope, end, end_slope]), np.eye(4), atol=EXACT)
    # a beam in pure bending: v = x2 / 2, rotation = x
    pure = np.array([0.0, 0.0, L**2 / 2, L])
    for xi in (0.2, 0.65):
        v, rotation = bending_functions(xi, L, phi)
        assert v @ pure == pytest.approx((xi * L) ** 2 / 2, rel=ROUND_OFF)
        assert rotation @ pure == pytest.approx(xi * L, rel=ROUND_OFF)


def test_gauss_points_give_the_consistent_mass_matrix_of_the_textbook():
    L = 0.7
    _, masses, shapes = beam_mass_points(TUBE, STEEL, L, (0.0, 0.0), "consistent", rotary=False)
    M = np.einsum("k,kai,kaj->ij", masses, shapes, shapes)
    mu = STEEL.rho * TUBE.area * L / 420
    bending = mu * np.array(
        [
            [156, 22 * L, 54, -13 * L],
            [22 * L, 4 * L**2, 13 * L, -3 * L**2],
            [54, 13 * L, 156, -22 * L],
            [-13 * L, -3 * L**2, -22 * L, 4 * L**2],
        ]
    )
    np.testing.assert_allclose(M[np.ix_([1, 5, 7, 11], [1, 5, 7, 11])], bending, rtol=EXACT, atol=1e-14)
    np.testing.assert_allclose(M[np.ix_([0, 6], [0, 6])], mu * np.array([[140, 70], [70, 140]]), rtol=EXACT)
    np.testing.assert_array_equal(M[3], 0.0)


def test_points_of_the_sections_give_the_rotary_inertia_of_rayleighs_beam():
    L, section = 0.4, rectangle(0.03, 0.05)
    plain, rayleigh = (
        np.einsum("k,kai,kaj->ij", m, N, N)
        for _, m, N in (
            beam_mass_points(section, STEEL, L, (0.0, 0.0), "consistent", rotary) for rotary in (False, True)
        )
    )
    extra = rayleigh - plain
    slope = (
        STEEL.rho
        / (30 * L)
        * np.array(
            [
                [36, 3 * L, -36, 3 * L],
                [3 * L, 4 * L**2, -3 * L, -(L**2)],
                [-36, -3 * L, 36, -3 * L],
                [3 * L, -(L**2), -3 * L, 4 * L**2],
            ]
        )
    )
    np.testing.assert_allclose(extra[np.ix_([1, 5, 7, 11], [1, 5, 7, 11])], section.Iz * slope, rtol=1e-9, atol=1e-12)
    polar = STEEL.rho * (section.Iy + section.Iz) * L / 6
    np.testing.assert_allclose(extra[np.ix_([3, 9], [3, 9])], polar * np.array([[2, 1], [1, 2]]), rtol=1e-9)


@pytest.mark.parametrize("kind", ["lumped", "consistent"])
@pytest.mark.parametrize("rotary", [False, True])
def test_every_mass_model_has_the_mass_and_the_centre_of_the_beams(kind, rotary):
    frame = portal()
    points = frame.finite_element_model(kind, rotary).mass
    total, moment = frame.masses.sum(), frame.masses @ frame.positions
    for element, beam in enumerate(frame.beams):
        mass = STEEL.rho * TUBE.area * frame.element_axes(element)[0]
        total, moment = total + mass, moment + mass * (frame.positions[beam.i] + frame.positions[beam.j]) / 2
    assert points.masses.sum() == pytest.approx(total, rel=EXACT)
    np.testing.assert_allclose(points.masses @ points.positions, moment, rtol=1e-11, atol=1e-12)


def test_lumping_costs_frequency_in_proportion_to_the_element_squared():
    L = 1.5
    errors = []
    for n in (8, 16, 32):
        hertz, _ = natural_modes(straight(n, L).finite_element_model("lumped", rotary=False), 1, CLAMPED)
        exact = CANTILEVER[0] ** 2 / (2 * np.pi * L**2) * np.sqrt(STEEL.E * TUBE.Iy / (STEEL.rho * TUBE.area))
        errors.append(hertz[0] / exact - 1)
    assert errors[0] < 0, "lumped masses at the tip lower the frequency"
    order = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(order, 2.0, atol=0.05)


def test_energies_of_rigid_motions_and_constant_strains_are_exact():
    model = portal().finite_element_model()
    R = model.rigid_motions(model.positions.mean(axis=0))
    assert np.abs(model.K @ R).max() < 1e-9 * np.abs(model.K.data).max()
    # patch: a bar of unequal elements stretched evenly has one force in all of them
    x = np.array([0.0, 0.1, 0.45, 0.5, 1.2])
    frame = straight(4)
    uneven = type(frame)(np.c_[x, np.zeros((5, 2))], frame.beams)
    u = np.zeros(30)
    u[::6] = 1e-4 * x
    force = uneven.finite_element_model().K @ u
    np.testing.assert_allclose(force[[0, 24]], STEEL.E * TUBE.area * 1e-4 * np.array([-1, 1]), rtol=ROUND_OFF)
    assert np.abs(np.delete(force, [0, 24])).max() < 1e-9 * abs(force[0])
