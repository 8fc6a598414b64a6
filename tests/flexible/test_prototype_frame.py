"""The frame of the prototype car against the figures its layout was published with in the project."""

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.linalg import eigh
from scipy.sparse.linalg import spsolve

from benchmarks.car.statics import interface_forces
from mbs.flexible.component_modes import craig_bampton
from mbs.flexible.fe_model import FiniteElementModel
from mbs.flexible.frequencies import natural_modes
from mbs.flexible.inertia_integrals import shape_integrals
from mbs.flexible.recovery import gauge_rows, peak_tube_stress, section_force_field
from mbs.flexible.relief_solution import inertia_relief
from mbs.vehicle import load

CAR = load("prototype")
FRAME = CAR.frame_section.tubular(CAR.folder)
INTERFACES, REFERENCE = CAR.flexible_frame.interfaces, str(CAR.flexible_frame.reference)
DYNAMIC_MODES = FRAME.section.dynamic_modes
DAMPING = CAR.flexible_frame.damping

# project data: computed once from the same layout by an independent script (dense numpy, own elements)
LOADED_HZ = [15.20, 23.56, 27.45, 28.23, 28.81, 30.50, 32.44, 34.29, 34.79, 42.60, 46.27, 47.91, 53.06, 56.52, 61.03]
BARE_HZ = [36.38, 59.40, 66.11, 73.49]
FIXED_HZ = [27.25, 27.52, 31.68, 33.91, 35.64]
REDUCED_ERROR_PERCENT = [1.0, 5.7, 2.9, 0.1, 0.3, 0.2]  # with the five modes of the car
TORSION = 2370.0  # N m/deg
STATIC_MOMENTS = {(1, 1): [3.66, -3.85], (1, 2): [3.94, -7.30]}  # N m at SG1/2 and SG3/4
PEAK_STRESS = 26.43e6  # Pa
SAG = [0.35e-3, 0.30e-3]  # m, at the gauges
FIGURES = 4e-4  # two digits after the point, and no rotary inertia of bending in them
MOMENT_DIGITS = 5e-3


@pytest.fixture(scope="module")
def model() -> FiniteElementModel:
    return FRAME.frame()[0].finite_element_model()


def test_size_mass_and_inertia(model: FiniteElementModel) -> None:
    frame, tubes = FRAME.frame()
    assert (len(frame.positions), model.n_dof, len(frame.beams), len(tubes)) == (211, 1266, 282, 129)
    assert model.mass.masses.sum() - frame.masses.sum() == pytest.approx(73.67, abs=0.005)  # of the tubes
    chassis = CAR.chassis
    assert model.mass.masses.sum() == pytest.approx(chassis.mass, abs=1e-3)
    x = model.mass.positions - np.array(chassis.com)
    np.testing.assert_allclose(model.mass.masses @ x / model.mass.masses.sum(), 0.0, atol=5e-5)
    J = (model.mass.masses[:, None] * x).T @ x
    np.testing.assert_allclose(np.trace(J) * np.eye(3) - J, chassis.tensor, atol=0.051)


def test_every_interface_is_a_hardpoint_of_the_car() -> None:
    frame, _ = FRAME.frame()
    points = dict(zip(frame.names, frame.positions, strict=True))
    for node, name in {
        "LF": "lower_pivot_front", "LR": "lower_pivot_rear", "UF": "upper_pivot_front",
        "UR": "upper_pivot_rear", "RK": "tie_rod_inner", "TF": "spring_upper",
    }.items():  # fmt: skip
        np.testing.assert_array_equal(points[node + "L"], getattr(CAR.front.suspension.points, name))
    for node, name in {
        "AF": "lower_pivot_front", "AR": "lower_pivot_rear", "TL": "toe_link_inner", "TR": "strut_top"
    }.items():  # fmt: skip
        np.testing.assert_array_equal(points[node + "L"], getattr(CAR.rear.suspension.points, name))
    assert len(INTERFACES) == 20


def test_free_frequencies_loaded_and_bare(model: FiniteElementModel) -> None:
    hertz, _ = natural_modes(model, 21)
    assert hertz[:6].max() < 1e-2
    np.testing.assert_allclose(hertz[6:], LOADED_HZ, rtol=FIGURES)
    bare, _ = natural_modes(FRAME.frame(carried_masses=False)[0].finite_element_model(), 10)
    np.testing.assert_allclose(bare[6:], BARE_HZ, rtol=FIGURES)


def test_torsional_stiffness_between_the_towers(model: FiniteElementModel) -> None:
    fixed = np.concatenate([model.freedoms("TRL"), model.freedoms("TRR"), model.freedoms(REFERENCE)[1:2]])
    free = np.setdiff1d(np.arange(model.n_dof), fixed)
    left, right = (model.freedoms(n)[2] for n in ("TFL", "TFR"))
    F = np.zeros(model.n_dof)
    F[left], F[right] = 1000.0, -1000.0
    u = np.zeros(model.n_dof)
    u[free] = spsolve(sp.csc_matrix(model.K[free][:, free]), F[free])
    base = 2 * model.positions[model.node("TFL")][1]
    assert 1000.0 * base / np.degrees((u[left] - u[right]) / base) == pytest.approx(TORSION, rel=5e-4)


def test_craig_bampton_has_the_frequencies_and_the_errors_of_the_data(model: FiniteElementModel) -> None:
    count = DYNAMIC_MODES
    body = craig_bampton(model, REFERENCE, INTERFACES, count, damping=DAMPING)
    assert body.n_static == 60
    assert body.n_modes == 60 + count
    np.testing.assert_allclose(body.frequencies, FIXED_HZ, rtol=FIGURES)
    V = np.hstack([model.rigid_motions(), body.modes])
    squares = eigh(V.T @ (model.K @ V), V.T @ (model.mass_matrix() @ V), eigvals_only=True)
    full = natural_modes(model, 12)[0][6:]
    error = 100 * (np.sqrt(squares[6:12]) / (2 * np.pi) / full - 1)
    np.testing.assert_allclose(error, REDUCED_ERROR_PERCENT, atol=0.051)
    integrals = shape_integrals(body)
    assert integrals.T.shape == (60 + count, 60 + count, 3, 3)
    np.testing.assert_allclose(integrals.modal_mass(), body.M, atol=1e-10 * body.M.max())


def test_gauges_sit_where_the_data_puts_them_at_every_refinement() -> None:
    places = {"SG1": (-0.25, 0.345), "SG2": (-0.25, -0.345), "SG3": (-1.7875, 0.425), "SG4": (-1.7875, -0.425)}
    for refinement in (1, 2, 3):
        frame, tubes = FRAME.frame(refinement=refinement)
        for gauge in FRAME.strain_gauges(tubes):
            beam = frame.beams[gauge.element]
            place = (1 - gauge.xi) * frame.positions[beam.i] + gauge.xi * frame.positions[beam.j]
            np.testing.assert_allclose(place[:2], places[gauge.name], atol=1e-12)
    frame, tubes = FRAME.frame()
    assert [g.element for g in FRAME.strain_gauges(tubes)] == [38, 40, 127, 129]
    assert list(FRAME.section.gauges) == ["SG1", "SG2", "SG3", "SG4"]


@pytest.mark.parametrize("factors", list(STATIC_MOMENTS))
def test_gauge_moments_by_inertia_relief(model: FiniteElementModel, factors: tuple[int, int]) -> None:
    frame, tubes = FRAME.frame()
    moments, bridges = gauge_rows(frame, FRAME.strain_gauges(tubes))
    forces = interface_forces(INTERFACES, *factors)
    relief = inertia_relief(model, REFERENCE, INTERFACES, moments)
    actual = relief.balanced @ forces
    front, rear = STATIC_MOMENTS[factors]
    np.testing.assert_allclose(actual, [front, front, rear, rear], rtol=MOMENT_DIGITS)
    if factors == (1, 1):
        np.testing.assert_allclose(relief.acceleration_of_forces @ forces, [0, 0, 9.81, 0, 0, 0], atol=5e-4)
    # half-bridge: upper minus lower fibre = 2 M r / I
    stress = inertia_relief(model, REFERENCE, INTERFACES, bridges).balanced @ forces
    tube = frame.beams[FRAME.strain_gauges(tubes)[0].element].section
    np.testing.assert_allclose(stress, 2 * actual * 0.020 / tube.Iy, rtol=1e-9)


def test_largest_stress_and_sag_at_rest(model: FiniteElementModel) -> None:
    frame, _ = FRAME.frame()
    forces = interface_forces(INTERFACES)
    field = inertia_relief(model, REFERENCE, INTERFACES, section_force_field(frame)).balanced @ forces
    assert peak_tube_stress(frame, field).max() == pytest.approx(PEAK_STRESS, abs=0.05e6)
    towers = np.zeros((2, model.n_dof))
    for row, name in enumerate(("TFL", "TRL")):
        towers[row, model.freedoms(name)[2]] = 1.0
    sag = inertia_relief(model, REFERENCE, INTERFACES, towers).balanced @ forces
    np.testing.assert_allclose(sag, SAG, atol=0.005e-3)
