"""The reduction: unit interfaces, exact statics, frequencies from above, and bodies of other bases."""

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.linalg import eigh
from scipy.sparse.linalg import spsolve

from mbs.common.errors import ModelError
from mbs.flexible.component_modes import craig_bampton
from mbs.flexible.damping import RayleighDamping
from mbs.flexible.fe_model import FiniteElementModel
from mbs.flexible.fixed_interface import Interface
from mbs.flexible.frequencies import natural_modes
from mbs.flexible.load_paths import interface_loads, load_path_modes
from mbs.flexible.material import Material
from mbs.flexible.matrix_files import external_model
from mbs.flexible.mode_choice import modes_for_output
from mbs.flexible.recovery import section_forces
from mbs.flexible.reduced_body import ReducedBody
from mbs.flexible.section import round_bar
from tests.flexible.structures import portal, straight

REFERENCE = "N0"
INTERFACES = ("N2", "N4", "N7")


def free_frequencies(body: ReducedBody, model: FiniteElementModel) -> np.ndarray:
    """Elastic frequencies of the reduced body with its six rigid motions, Hz."""
    V = np.hstack([model.rigid_motions(body.origin), body.modes])
    squares = eigh(V.T @ (model.K @ V), V.T @ (model.mass_matrix() @ V), eigvals_only=True)
    return np.sqrt(squares[6:]) / (2 * np.pi)


@pytest.fixture(scope="module")
def model() -> FiniteElementModel:
    return portal().finite_element_model()


def test_static_amplitudes_are_the_displacements_of_the_interfaces(model: FiniteElementModel) -> None:
    body = craig_bampton(model, REFERENCE, [*INTERFACES[:2], Interface("N7", rotations=True)], 4)
    assert body.n_modes == 3 + 3 + 6 + 4
    assert body.n_static == 12
    for name, interface in body.interfaces.items():
        expected = np.zeros((3, body.n_modes))
        expected[range(3), interface.translation] = 1.0
        np.testing.assert_array_equal(body.interface_translation(name), expected)
    expected = np.zeros((3, body.n_modes))
    expected[range(3), body.interface("N7").rotation] = 1.0
    np.testing.assert_array_equal(body.node_rotations[body.interface("N7").node], expected)
    assert body.interface("N2").rotation is None
    assert body.mode_names[9:13] == ("N7 rx", "N7 ry", "N7 rz", "dynamic 1")
    reference = body.node_names.index(REFERENCE)
    np.testing.assert_array_equal(body.node_positions[reference], 0.0)
    np.testing.assert_array_equal(body.node_translations[reference], 0.0)
    np.testing.assert_array_equal(body.node_rotations[reference], 0.0)


def test_reduced_matrices_are_those_of_the_model_in_the_modes(model: FiniteElementModel) -> None:
    damping = RayleighDamping.fitted(0.02, 15.0, 60.0)
    body = craig_bampton(model, REFERENCE, INTERFACES, 5, damping=damping)
    V = body.modes
    np.testing.assert_allclose(V.T @ (model.K @ V), body.K, atol=1e-9 * body.K.max())
    np.testing.assert_allclose(V.T @ (model.mass_matrix() @ V), body.M, atol=1e-10)
    np.testing.assert_allclose(body.M[9:, 9:], np.eye(5), atol=1e-8)
    np.testing.assert_allclose(body.C, damping.alpha * body.M + damping.beta * body.K, rtol=1e-12, atol=1e-12)
    for hertz in (15.0, 60.0):
        w = 2 * np.pi * hertz
        assert damping.alpha / (2 * w) + damping.beta * w / 2 == pytest.approx(0.02)
    assert np.linalg.eigvalsh(body.K).min() > 0


def test_loads_at_the_interfaces_deform_the_reduced_body_exactly(model: FiniteElementModel) -> None:
    body = craig_bampton(model, REFERENCE, INTERFACES)
    load = np.random.default_rng(1).normal(size=9)
    F = np.zeros(model.n_dof)
    F[np.concatenate([model.freedoms(n) for n in INTERFACES])] = load
    free = np.setdiff1d(np.arange(model.n_dof), model.reference_freedoms(REFERENCE))
    u = np.zeros(model.n_dof)
    u[free] = spsolve(sp.csc_matrix(model.K[free][:, free]), F[free])
    np.testing.assert_allclose(body.modes @ np.linalg.solve(body.K, load), u, rtol=1e-7, atol=1e-9 * np.abs(u).max())


def test_reduced_frequencies_come_down_to_those_of_the_model(model: FiniteElementModel) -> None:
    full = natural_modes(model, 10)[0][6:]
    errors = []
    for count in (0, 5, 10, 20):
        reduced = free_frequencies(craig_bampton(model, REFERENCE, INTERFACES, count), model)[:4]
        errors.append(reduced / full - 1)
        assert (errors[-1] > -1e-7).all(), "a Ritz value cannot lie below"
    assert (np.diff(np.array(errors), axis=0) < 1e-9).all()
    assert errors[-1].max() < 1e-3 < errors[0].max()


def test_all_modes_give_the_model_back(model: FiniteElementModel) -> None:
    inner = model.n_dof - 6 - 9
    body = craig_bampton(model, REFERENCE, INTERFACES, inner)
    full = natural_modes(model, 16)[0][6:]
    np.testing.assert_allclose(free_frequencies(body, model)[:10], full, rtol=1e-6)


def test_modes_are_chosen_by_frequency_and_by_number(model: FiniteElementModel) -> None:
    fixed = natural_modes(model, 12, _held(model))
    limit = (fixed[0][6] + fixed[0][7]) / 2
    by_frequency = craig_bampton(model, REFERENCE, INTERFACES, up_to=limit)
    by_count = craig_bampton(model, REFERENCE, INTERFACES, 7)
    np.testing.assert_allclose(by_frequency.frequencies, fixed[0][:7], rtol=1e-8)
    np.testing.assert_allclose(by_count.frequencies, by_frequency.frequencies, rtol=1e-8)
    some = craig_bampton(model, REFERENCE, INTERFACES, [1, 4])
    np.testing.assert_allclose(some.frequencies, fixed[0][[1, 4]], rtol=1e-8)
    assert craig_bampton(model, REFERENCE, INTERFACES, up_to=1.0).frequencies.size == 0


def _held(model: FiniteElementModel) -> np.ndarray:
    return np.concatenate([model.reference_freedoms(REFERENCE), *(model.freedoms(n) for n in INTERFACES)])


def test_inertia_modes_make_weight_and_steady_acceleration_exact(model: FiniteElementModel) -> None:
    R = model.rigid_motions(model.origin(REFERENCE))
    load = model.mass_matrix() @ R @ np.array([1.0, -2.0, 9.81, 3.0, 1.0, -4.0])
    free = np.setdiff1d(np.arange(model.n_dof), model.reference_freedoms(REFERENCE))
    u = np.zeros(model.n_dof)
    u[free] = spsolve(sp.csc_matrix(model.K[free][:, free]), load[free])
    for count in (0, 3):
        errors = []
        for inertia in (False, True):
            body = craig_bampton(model, REFERENCE, INTERFACES, count, inertia_modes=inertia)
            result = body.modes @ np.linalg.solve(body.K, body.modes.T @ load)
            errors.append(np.abs(result - u).max() / np.abs(u).max())
            np.testing.assert_allclose(body.K[:9, 9:], 0.0)
        assert errors[1] < 1e-7 < 1e-3 < errors[0]


def test_a_named_output_takes_the_modes_it_needs() -> None:
    frame = portal()
    model = frame.finite_element_model()
    rows = section_forces(frame, 2, 0.5)[[4], : model.n_dof]
    loose, tight = (modes_for_output(model, REFERENCE, INTERFACES, rows, t, 30) for t in (0.2, 0.01))
    assert 0 < len(loose.modes) < len(tight.modes) < 30
    assert loose.left_out <= 0.2
    assert tight.left_out <= 0.01
    # the promise holds in the reduced body: the moment under a steady acceleration
    load = np.asarray(model.mass_matrix() @ model.rigid_motions(model.origin(REFERENCE)))[:, :3]
    exact = craig_bampton(model, REFERENCE, INTERFACES, 0, inertia_modes=True)
    for choice, tolerance in ((loose, 0.2), (tight, 0.01)):
        body = craig_bampton(model, REFERENCE, INTERFACES, choice.modes)
        moments = []
        for b in (body, exact):
            fixed_modes = b.modes[:, b.n_static :]  # interfaces held
            moments.append(np.asarray(rows @ fixed_modes) @ np.linalg.solve(b.K[9:, 9:], fixed_modes.T @ load))
        assert np.abs(moments[0] - moments[1]).max() <= 1.01 * tolerance * _largest(model, rows)
    with pytest.raises(ModelError, match="leave an error of"):
        modes_for_output(model, REFERENCE, INTERFACES, rows, 1e-9, 5)
    with pytest.raises(ModelError, match="a fraction between 0 and 1"):
        modes_for_output(model, REFERENCE, INTERFACES, rows, 2.0)


def test_inertia_modes_leave_only_fast_motions_to_the_dynamic_modes() -> None:
    frame = portal()
    model = frame.finite_element_model()
    rows = section_forces(frame, 2, 0.5)[[4], : model.n_dof]
    hertz = natural_modes(model, 30, _held(model))[0]

    def chosen(frequency: float, inertia: bool) -> tuple[int, ...]:
        choice = modes_for_output(model, REFERENCE, INTERFACES, rows, 0.02, 30, frequency, inertia)
        assert choice.left_out <= 0.02
        return choice.modes

    assert chosen(0.0, inertia=True) == ()
    slow, fast = chosen(hertz[0] / 3, inertia=True), chosen(hertz[2] * 1.01, inertia=True)
    assert 0 < len(slow) < len(chosen(hertz[0] / 3, inertia=False))
    assert set(range(3)) <= set(fast), "modes below the frequency that matters are never left out"


def test_a_straight_beam_without_rotary_inertia_has_no_inertia_mode_about_its_axis() -> None:
    """Five are left of six, and the weight and steady accelerations bend it exactly."""
    model = straight(8).finite_element_model(rotary=False)
    body = craig_bampton(model, 0, [Interface(8, rotations=True)], 0, inertia_modes=True)
    assert body.n_modes - body.n_static == 5
    load = np.asarray(model.mass_matrix() @ model.rigid_motions(model.origin(0)))
    fixed = np.r_[:6, 48:54]
    free = np.setdiff1d(np.arange(model.n_dof), fixed)
    exact = spsolve(sp.csc_matrix(model.K[free][:, free]), load[free])
    shapes = body.modes[free, body.n_static :]
    result = shapes @ np.linalg.solve(body.K[body.n_static :, body.n_static :], shapes.T @ load[free])
    assert np.abs(result - exact).max() < 1e-9 * np.abs(exact).max()


def _largest(model: FiniteElementModel, rows: sp.sparray) -> float:
    exact = craig_bampton(model, REFERENCE, INTERFACES, 0, inertia_modes=True)
    load = np.asarray(model.mass_matrix() @ model.rigid_motions(model.origin(REFERENCE)))
    load[:, 3:] /= np.ptp(model.positions, axis=0).max()
    fixed_modes = exact.modes[:, 9:]
    return float(np.abs(np.asarray(rows @ fixed_modes) @ np.linalg.solve(exact.K[9:, 9:], fixed_modes.T @ load)).max())


def test_load_path_modes_keep_only_the_modes_that_the_loads_excite(model: FiniteElementModel) -> None:
    body = craig_bampton(model, REFERENCE, INTERFACES, 0, inertia_modes=True)
    rod = np.array([1.0, 2.0, -1.0]) / np.sqrt(6.0)
    loads = interface_loads(body, {"N2": np.eye(3), "N4": rod, "N7": np.array([[0.0, 0.0, 1.0]])})
    assert loads.shape == (9, 5)
    small = load_path_modes(body, loads)
    assert small.n_modes == 5
    np.testing.assert_allclose(small.M, np.eye(5), atol=1e-8)
    np.testing.assert_allclose(np.diag(small.K), (2 * np.pi * small.frequencies) ** 2, rtol=1e-8)
    # forces at the interfaces with the inertia that balances them: same deformation in both
    force = loads @ np.array([3.0, -1.0, 2.0, 5.0, 4.0])
    results = []
    for b in (body, small):
        R = model.rigid_motions(b.origin)
        F = np.zeros(model.n_dof)
        F[np.concatenate([model.freedoms(n) for n in INTERFACES])] = force
        F -= model.mass_matrix() @ R @ np.linalg.solve(R.T @ (model.mass_matrix() @ R), R.T @ F)
        results.append(b.modes @ np.linalg.solve(b.K, b.modes.T @ F))
    np.testing.assert_allclose(results[1], results[0], rtol=1e-6, atol=1e-7 * np.abs(results[0]).max())
    with pytest.raises(ModelError, match="9 rows are needed"):
        load_path_modes(body, np.ones((4, 2)))
    with pytest.raises(ModelError, match="nothing that deforms the body"):
        interface_loads(body, {})


def test_a_translation_only_model_is_held_at_three_nodes() -> None:
    """A truss-like block of springs between all pairs of eight corners."""
    x = np.array([[i, j, k] for i in (0.0, 1.0) for j in (0.0, 0.7) for k in (0.0, 0.4)])
    K = np.zeros((24, 24))
    for a in range(8):
        for b in range(a):
            d = x[a] - x[b]
            k = 1e5 * np.outer(d, d) / (d @ d)
            for i, j, sign in ((a, a, 1), (b, b, 1), (a, b, -1), (b, a, -1)):
                K[3 * i : 3 * i + 3, 3 * j : 3 * j + 3] += sign * k
    block = external_model(K, np.full(8, 2.0), x)
    body = craig_bampton(block, (0, 3, 5), [7], 3)
    np.testing.assert_array_equal(body.node_translations[0], 0.0)
    np.testing.assert_array_equal(body.node_rotations, 0.0)
    full = natural_modes(block, 24)[0]
    complete = craig_bampton(block, (0, 3, 5), [7], 24 - 6 - 3)
    np.testing.assert_allclose(free_frequencies(complete, block), full[6:], rtol=1e-7)
    with pytest.raises(ModelError, match="on one line"):
        craig_bampton(block, (0, 1, 1), [7])
    with pytest.raises(ModelError, match="has no rotations"):
        craig_bampton(block, 0, [7])
    with pytest.raises(ModelError, match="not 2 nodes"):
        craig_bampton(block, (0, 1), [7])


def test_a_clamped_tube_reduces_to_its_tip() -> None:
    body = craig_bampton(straight(8).finite_element_model(), 0, [Interface(8, rotations=True)])
    one = straight(1).element_stiffness(0)[6:, 6:]
    np.testing.assert_allclose(body.K, one, rtol=1e-6, atol=1e-4)


@pytest.mark.parametrize(("E", "length", "diameter"), [(9e9, 0.3, 0.011), (2e9, 0.33, 0.012)])
def test_some_of_several_modes_of_one_frequency_are_taken(E: float, length: float, diameter: float) -> None:
    """A round beam held at its ends and in its middle: each half vibrates alike in two planes, four equal modes. In
    these beams LAPACK's subset of two of them was empty."""
    material, section = Material(E, 0.3, 2000.0), round_bar(diameter)
    model = straight(4, length, section, "timoshenko", material=material).finite_element_model()
    ends = [Interface(node, rotations=True) for node in (0, 4)]
    clamped = 22.373 / (length / 2.0) ** 2 * np.sqrt(material.E * section.Iy / (material.rho * section.area))
    hertz = craig_bampton(model, 2, ends, 2).frequencies
    np.testing.assert_allclose(2.0 * np.pi * hertz, clamped, rtol=0.03)  # of two elements
