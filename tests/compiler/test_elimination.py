"""q_full = T z + z0 satisfies every linear joint equation, whatever the numbers."""

import numpy as np
import pytest

from mbs import ModelError
from mbs.common.affine import Affine
from mbs.compiler.elimination import eliminate
from mbs.compiler.polynomial import drop_round_off

ROUND_OFF = 1e-10


def random_equations(rng, n, count):
    equations = []
    for k in range(count):
        columns = rng.choice(n, size=rng.integers(2, 5), replace=False)
        equations.append((f"joint {k}", Affine({int(c): float(rng.normal()) for c in columns}, float(rng.normal()))))
    return equations


@pytest.mark.parametrize("seed", range(2))
def test_every_solution_of_z_solves_the_equations(seed):
    rng = np.random.default_rng(seed)
    n, count = 40, 25
    equations = random_equations(rng, n, count)
    result = eliminate(n, equations, set(), set())
    dense = np.array([[e.terms.get(i, 0.0) for i in range(n)] for _, e in equations])
    assert len(result.remaining) == n - np.linalg.matrix_rank(dense)
    for _ in range(3):
        z = rng.normal(size=len(result.remaining))
        q = np.array([e.value(z) for e in result.expressions])
        size = 1.0 + np.abs(q).max()
        assert max(abs(e.value(q)) for _, e in equations) < ROUND_OFF * size
        np.testing.assert_array_equal(q[result.remaining], z)


def test_dependent_equations_are_counted_and_contradictions_refused():
    a, b = Affine({0: 1.0, 1: -1.0}, 0.5), Affine({1: 2.0, 2: 1.0}, -1.0)
    total = a * 3.0 + b
    assert eliminate(3, [("a", a), ("b", b), ("sum", total)], set(), set()).redundant == 1
    with pytest.raises(ModelError, match="cannot close") as error:
        eliminate(3, [("a", a), ("b", b), ("sum", total + 1e-3)], set(), set())
    assert "0.001 m" in str(error.value) or "0.000333 m" in str(error.value)


def test_a_long_equation_waits_for_the_short_ones():
    """x_1 + .. + x_n = 0 beside x_k + y_k - y_(k+1) + y_(k+7)/2 = 0: solved first it would fill all others. The terms
    of the solution do not depend on where it stands among the equations.
    """
    n = 40
    short = [
        (f"short {k}", Affine({k: 1.0, n + k: 1.0, n + k + 1: -1.0, n + (k + 7) % (n + 1): 0.5})) for k in range(n)
    ]
    long = [("long", Affine(dict.fromkeys(range(n), 1.0)))]
    terms = [
        sum(len(e.terms) for e in eliminate(2 * n + 1, short[:k] + long + short[k:], set(), set()).expressions)
        for k in (0, n // 2, n)
    ]
    assert terms[0] == terms[1] == terms[2] <= 7 * n


def test_locked_coordinates_stay():
    result = eliminate(3, [("a", Affine({0: 1.0, 1: -1.0, 2: 5.0}))], {2}, set())
    assert 2 in result.remaining
    with pytest.raises(ModelError, match="prescribe it"):
        eliminate(3, [("a", Affine({2: 1.0}, -0.3))], {2}, set())


@pytest.mark.parametrize(("apart", "left"), [(1e-8, 0), (1e-12, 1)])
def test_an_equation_is_another_until_its_difference_is_round_off(apart, left):
    equations = [("a", Affine({0: 1.0, 1: -1.0})), ("b", Affine({0: 1.0, 1: apart - 1.0}))]
    result = eliminate(2, equations, set(), set())
    assert (len(result.remaining), result.redundant) == (left, left)


@pytest.mark.parametrize(("coefficient", "terms"), [(1e-8, 1), (1e-12, 0)])
def test_a_row_counts_until_it_is_round_off_of_its_terms(coefficient, terms):
    assert len(drop_round_off({(0, -1): coefficient}, largest=(0.0, 1.0, 0.0))) == terms
