"""Symbolic factorization: the fronts hold every entry of the factor, and the tree is a tree."""

import numpy as np
import pytest

from mbs import compile
from mbs.compiler.fronts import DENSE_SIZE, build_fronts
from mbs.compiler.ordering import clique_pattern, fill_reducing_order
from mbs.scenes import prototype_car
from tests.compiler.mechanisms import MODELS, compiled


def covered(fronts, n):
    """Entries (lower triangle) of the factor that the fronts have a place for."""
    place = np.zeros((n, n), dtype=bool)
    for s, index in enumerate(fronts.index):
        for k in range(fronts.col[s + 1] - fronts.col[s]):
            place[index[k:], index[k]] = True
    return place


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("n", [5, 60, 150])
def test_the_numeric_factor_fits_into_the_fronts(seed, n):
    rng = np.random.default_rng(seed)
    cliques = [rng.choice(n, size=rng.integers(2, 5), replace=False) for _ in range(n)]
    modes = rng.choice(n, size=5, replace=False)
    late = {int(c): 1 + k // 3 for k, c in enumerate(modes)}
    pattern = clique_pattern(n, [*cliques, modes])
    fronts = build_fronts(pattern, fill_reducing_order(pattern), late)
    for begin, end in zip(fronts.col[:-1], fronts.col[1:], strict=True):
        numbers = [(late[c], c) if c in late else (0, 0) for c in fronts.order[begin:end].tolist()]
        assert n <= DENSE_SIZE or numbers == sorted(numbers)  # modes last, each body's in their order
    assert sorted(fronts.order) == list(range(n))
    A = pattern.toarray() * rng.uniform(0.1, 1.0, size=(n, n))
    A = A + A.T + 2 * n * np.eye(n)
    A = A[np.ix_(fronts.order, fronts.order)]
    L = np.linalg.cholesky(A)
    assert not np.any((L != 0.0) & (np.abs(L) > 1e-14) & ~covered(fronts, n))
    for s, parent in enumerate(fronts.parent):
        rest = fronts.index[s][fronts.col[s + 1] - fronts.col[s] :]
        assert (parent == -1) == (len(rest) == 0)
        if len(rest):
            assert parent > s
            assert set(rest) <= set(fronts.index[parent])


def test_pivots_of_a_front_are_in_the_order_of_the_model():
    n = 60
    rng = np.random.default_rng(n)
    pattern = clique_pattern(n, [rng.choice(n, size=4, replace=False) for _ in range(n)])
    fronts = build_fronts(pattern, fill_reducing_order(pattern))
    pivots = [fronts.order[first:end] for first, end in zip(fronts.col, fronts.col[1:], strict=False)]
    assert max(map(len, pivots)) > 5
    assert all(np.all(np.diff(p) > 0) for p in pivots)


@pytest.mark.parametrize("name", MODELS)
def test_rows_and_mass_point_into_their_fronts(name):
    a = compiled(name).arrays
    for r, s in enumerate(a["row_front"]):
        part = slice(a["row_ptr"][r], a["row_ptr"][r + 1])
        index = a["front_idx"][a["front_ptr"][s] : a["front_ptr"][s + 1]]
        np.testing.assert_array_equal(index[a["row_loc"][part]], a["row_col"][part])
    mass_row = np.repeat(np.arange(len(a["q0"])), np.diff(a["mass_ptr"]))
    for k, at in enumerate(a["mass_pos"]):
        i, j = mass_row[k], a["mass_col"][k]
        if i < j:
            assert at == -1
            continue
        s = np.searchsorted(a["front_off"], at, side="right") - 1
        m = a["front_ptr"][s + 1] - a["front_ptr"][s]
        column, row = divmod(at - a["front_off"][s], m)
        index = a["front_idx"][a["front_ptr"][s] :]
        assert (index[row], index[column]) == (i, j)
        assert a["front_col"][s] <= j < a["front_col"][s + 1]


def test_modes_of_a_car_lie_side_by_side():
    a = compile(prototype_car.build(fidelity="dynamic")).arrays
    assert np.diff(a["flex_mode"]).tolist() == [1] * (len(a["flex_mode"]) - 1)
    assert max(a["flex_frame"]) < min(a["flex_mode"])
