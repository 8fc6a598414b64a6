"""Points: against SALib, in blocks as in one piece, and what each method promises."""

import itertools
from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest
from SALib.sample import sobol
from scipy.stats import qmc

from hosts.study.points import digest, grid_points, points_of_columns
from hosts.study.random_points import UnitPoints, latin_hypercube, saltelli, sobol_sequence


def in_blocks(places: UnitPoints, count: int, size: int) -> np.ndarray:
    return np.vstack([places(k, min(size, count - k)) for k in range(0, count, size)])


def test_points_for_sobol_indices_are_those_of_salib(monkeypatch: pytest.MonkeyPatch) -> None:
    # SALib gives its seed by SciPy's old name, which draws other points.
    ours = SimpleNamespace(Sobol=lambda d, scramble, seed: qmc.Sobol(d, scramble=scramble, rng=seed))
    monkeypatch.setattr(sobol, "qmc", ours)
    problem = {"num_vars": 3, "names": ["a", "b", "c"], "bounds": [[0.0, 1.0]] * 3}
    theirs = sobol.sample(problem, 16, calc_second_order=False, seed=5)
    assert np.array_equal(in_blocks(saltelli(3, 5), 80, 7), theirs)


@pytest.mark.parametrize(
    ("make", "count"),
    [
        (lambda: latin_hypercube(3, 50, 2), 50),
        (lambda: sobol_sequence(3, 2), 50),
        (lambda: saltelli(2, 2), 36),
        (lambda: grid_points((3, 4, 2)), 24),
    ],
)
def test_blocks_are_pieces_of_the_whole(make: Callable[[], UnitPoints], count: int) -> None:
    whole = make()(0, count)
    assert len(whole) == count
    assert np.array_equal(in_blocks(make(), count, 4), whole)
    places = make()
    places(10, 5)
    assert np.array_equal(places(3, 6), whole[3:9])  # back, as after a study was stopped


def test_a_latin_hypercube_has_one_point_in_each_slice() -> None:
    points = latin_hypercube(4, 30, 1)(0, 30)
    assert np.array_equal(np.sort(np.floor(30 * points), axis=0), np.tile(np.arange(30.0)[:, None], 4))


def test_sobol_points_are_balanced_at_a_power_of_two() -> None:
    points = sobol_sequence(2, 1)(0, 64)
    counts = np.histogram2d(points[:, 0], points[:, 1], bins=8, range=[[0, 1], [0, 1]])[0]
    assert (counts == 1).all()
    assert not np.array_equal(points, sobol_sequence(2, 2)(0, 64))


def test_a_grid_has_all_combinations_once_the_last_fastest() -> None:
    places = np.floor(grid_points((2, 3))(0, 6) * [2, 3]).astype(int)
    assert [tuple(place) for place in places] == list(itertools.product(range(2), range(3)))


@pytest.mark.parametrize("row", [0, 500, 999])
def test_a_change_of_any_row_of_a_table_is_seen(row: int) -> None:
    values: list[float | int | bool | str] = [float(k) for k in range(1000)]
    changed = [*values[:row], values[row] + 0.5, *values[row + 1 :]]  # type: ignore[operator]
    assert digest(points_of_columns({"a": values})) == digest(points_of_columns({"a": list(values)}))
    assert digest(points_of_columns({"a": values})) != digest(points_of_columns({"a": changed}))
