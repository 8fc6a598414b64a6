"""The sums over mass points against the same ones written out."""

import numpy as np
import pytest

from mbs.flexible.component_modes import craig_bampton
from mbs.flexible.inertia_integrals import ShapeIntegrals, shape_integrals
from mbs.flexible.reduced_body import ReducedBody
from tests.flexible.structures import portal

ROUND_OFF = 1e-12

KINDS = [("lumped", False), ("lumped", True), ("consistent", False), ("consistent", True)]


@pytest.fixture(scope="module", params=KINDS, ids=["-".join(map(str, k)) for k in KINDS])
def body(request: pytest.FixtureRequest) -> ReducedBody:
    kind, rotary = request.param
    return craig_bampton(portal().finite_element_model(kind, rotary), "N0", ["N3", "N7"], 3)


def test_integrals_have_their_symmetries_and_the_modal_mass(body: ReducedBody) -> None:
    s = shape_integrals(body)
    assert isinstance(s, ShapeIntegrals)
    n = body.n_modes
    assert (s.P.shape, s.c.shape, s.T.shape) == ((3, n), (3, n, 3), (n, n, 3, 3))
    np.testing.assert_allclose(s.modal_mass(), body.M, atol=ROUND_OFF * np.abs(body.M).max())
    np.testing.assert_array_equal(s.T, s.T.transpose(1, 0, 3, 2))
    assert s.mass == pytest.approx(body.masses.sum())
    x, weighted = body.mass_positions, body.masses[:, None] * body.mass_positions
    for actual, expected in ((s.S0, weighted.sum(axis=0)), (s.J0, weighted.T @ x)):
        np.testing.assert_allclose(actual, expected, atol=1e-12)
    np.testing.assert_allclose(s.P, np.einsum("k,kij->ij", body.masses, body.mass_shapes), atol=1e-13)
    j, l = 2, 5
    literal = np.einsum("k,ki,kj->ij", body.masses, body.mass_shapes[:, :, l], body.mass_shapes[:, :, j])
    np.testing.assert_allclose(s.T[j, l], literal, atol=1e-13)
    np.testing.assert_allclose(
        s.c[1, j], (body.masses * body.mass_positions[:, 1]) @ body.mass_shapes[:, :, j], atol=1e-13
    )
