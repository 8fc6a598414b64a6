"""Rows of the System: rigidity is kept distances, Phi_q is the derivative of Phi, scaling is as written."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mbs import Model
from mbs.common.affine import Affine
from mbs.compiler.dependent_rows import independent_rows
from mbs.compiler.polynomial import RowTerms
from mbs.compiler.rows import rigid_rows
from mbs.kernel.binding import LoadedSystem
from mbs.kernel.binding.instance import Instance
from tests.compiler.mechanisms import MODELS, compiled

DERIVATIVE = 2e-8
ROUND_OFF = 1e-12


@pytest.mark.parametrize("dimension", [2, 3])
def test_rigid_rows_vanish_for_rotations_and_only_for_those(dimension):
    m = Model("one", dimension=dimension)
    body = m.body("b", mass=1.0, com=np.zeros(dimension), inertia=0.2 if dimension == 2 else (0.2, 0.25, 0.3))
    for p in ((1.0, 0.2, 0.3), (0.1, 0.9, -0.4)):
        m.spherical(f"ball {p[0]}", m.ground, body, point=p[:dimension])
    full = [Affine({i: 1.0}) for i in range(body.size)]
    rows = rigid_rows(body, full)
    assert len(rows) == (1 if dimension == 2 else 6)

    def values(q):
        padded = np.append(q, 1.0)
        return np.array([sum(v * padded[i] * padded[j] for (i, j), v in r.main.items()) for r in rows])

    if dimension == 2:
        rigid = np.array([0.3, 0.1, np.cos(0.7), np.sin(0.7)])
    else:
        rigid = np.concatenate([[0.3, 0.1, 0.2], *Rotation.from_rotvec([0.3, -1.0, 0.4]).as_matrix().T])
    assert np.max(np.abs(values(rigid))) < ROUND_OFF
    # any strain is seen: the rows have full rank in the deformations of the axes
    h = 1e-6
    jacobian = np.array([(values(rigid + h * e) - values(rigid - h * e)) / (2 * h) for e in np.eye(len(rigid))]).T
    assert np.linalg.matrix_rank(jacobian, tol=1e-3) == len(rows)


@pytest.mark.parametrize(("size", "left"), [(0.0, 2), (1e-8, 2), (1e-6, 3), (5e-4, 3)])
def test_a_remainder_of_rounded_numbers_is_no_condition_of_its_own(size, left):
    """Two squares and their sum with a remainder: below 1e-7 of the row it is round-off of the drawing."""
    one, two = {(0, 0): 1.0, (1, 1): 1.0, (-1, -1): -1.0}, {(0, 0): 1.0, (1, 1): -0.5, (-1, -1): -0.5}
    both = {m: one[m] + two[m] for m in one} | {(2, 2): 2.0 * size}
    rows = [RowTerms(f"row {k}", "distance", k, 0, main) for k, main in enumerate((one, two, both))]
    kept, removed = independent_rows(rows, {}, 1.0)
    assert (len(kept), removed) == (left, 3 - left)


def loaded(name):
    system = compiled(name)
    return system, Instance(LoadedSystem(system.to_bytes()))


@pytest.mark.parametrize("name", MODELS)
def test_jacobian_is_the_derivative_of_the_rows(name):
    system, instance = loaded(name)
    instance.initialise(0.0)
    rng = np.random.default_rng(3)
    q = system.arrays["q0"] + 0.1 * rng.normal(size=system.nq)
    qd = rng.normal(size=system.nq)
    y = system.arrays["y0"]

    def phi(at):
        return np.array(instance.evaluate(at.tolist(), qd.tolist(), y.tolist(), 0.0)["phi"])

    result = instance.evaluate(q.tolist(), qd.tolist(), y.tolist(), 0.0)
    values = np.array(result["jacobian"])
    dense = np.zeros((system.nc, system.nq))
    row = np.repeat(np.arange(system.nc), np.diff(system.arrays["row_ptr"]))
    dense[row, system.arrays["row_col"]] = values
    h = 1e-6
    differences = np.array([(phi(q + h * e) - phi(q - h * e)) / (2 * h) for e in np.eye(system.nq)]).T
    scale = np.max(np.abs(dense))
    assert scale > 0.1
    np.testing.assert_allclose(dense, differences, rtol=0, atol=DERIVATIVE * scale)


@pytest.mark.parametrize("name", MODELS)
def test_start_is_consistent_and_rows_are_scaled_by_the_mass(name):
    system, instance = loaded(name)
    a = system.arrays
    instance.initialise(0.0)
    result = instance.evaluate(a["q0"].tolist(), a["qd0"].tolist(), a["y0"].tolist(), 0.0)
    phi, values = np.array(result["phi"]), np.array(result["jacobian"])
    assert np.max(np.abs(phi) * a["row_measure"]) < 1e-10
    row = np.repeat(np.arange(system.nc), np.diff(a["row_ptr"]))
    Jv = np.bincount(row, values * a["qd0"][a["row_col"]], minlength=system.nc) + np.array(result["phi_t"])
    assert np.max(np.abs(Jv) * a["row_measure"]) < 1e-9
    mass_row = np.repeat(np.arange(system.nq), np.diff(a["mass_ptr"]))
    diagonal = np.zeros(system.nq)
    on = mass_row == a["mass_col"]
    diagonal[mass_row[on]] = a["mass_val"][on]
    weights = np.where(diagonal > 0, 1.0 / np.where(diagonal > 0, diagonal, 1.0), 0.0)
    unit = np.bincount(row, values**2 * weights[a["row_col"]], minlength=system.nc)
    np.testing.assert_allclose(unit, 1.0, rtol=1e-6)
    length = np.sqrt(np.bincount(row, values**2, minlength=system.nc))
    np.testing.assert_allclose(a["row_measure"] * length, 1.0, rtol=1e-6)
