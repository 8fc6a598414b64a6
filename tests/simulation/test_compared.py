"""The comparison of two motions in the kernel, which FMUs use, is that of Python."""

from __future__ import annotations

import numpy as np
import pytest

from mbs.results import comparison
from mbs.results.compared import compared
from mbs.results.comparison import Compared, compared_in

LENGTH = 2.0
KINDS = {
    "place": Compared("m", place=True),
    "small place": Compared("m", place=True),
    "turning": Compared("rad", place=True),
    "heading": Compared("rad", place=True, wrapped=True),
    "force": Compared("N", load=True),
    "rate": Compared("m/s", always=False),
    "torque": Compared("N m", load=True, always=False),
    "coordinate": Compared("1", place=True),
}


def motion(rng: np.random.Generator, name: str) -> np.ndarray:
    """Few samples, so that forces are compared at all of them; some rest, none turns by more than a quarter at once."""
    size = float(rng.choice([0.0, 1e-5, 1e-3, 1.0]))
    values = 5.0 * float(rng.integers(2)) + size * np.cumsum(rng.uniform(-1.5, 1.5, 4))
    return (values + np.pi) % (2.0 * np.pi) - np.pi if KINDS[name].wrapped else values


def test_gaps_and_sizes_are_those_of_python() -> None:
    for seed in range(400):
        compare_one(seed)


def compare_one(seed: int) -> None:
    rng = np.random.default_rng(seed)
    names = [name for name in KINDS if rng.random() < 0.6] or ["place"]
    fine = {name: motion(rng, name) for name in names}
    shift = {name: float(rng.choice([0.0, 1e-9, 0.1])) * np.ptp(fine[name]) for name in names}
    coarse = {name: values + shift[name] * rng.uniform(-1.0, 1.0, len(values)) for name, values in fine.items()}
    guided = bool(rng.integers(2))
    judged = compared_in(fine, {name: KINDS[name] for name in names}, LENGTH, guided=guided)
    _, gaps, sizes = comparison.differences(coarse, fine, judged, None, LENGTH)
    found, held_against = compared(coarse, fine, {name: KINDS[name] for name in names}, LENGTH, guided)
    assert held_against == pytest.approx(sizes, rel=1e-12)
    assert found == pytest.approx(gaps, rel=1e-9, abs=1e-15)


def test_an_angle_that_is_not_followed_judges_nothing_and_is_no_size_of_others() -> None:
    fine = {"turning": np.array([0.0, 0.1, 0.2, 0.3]), "heading": np.array([0.0, 3.0, -1.0, 2.0])}
    coarse = {name: values + 0.01 for name, values in fine.items()}
    gaps, sizes = compared(coarse, fine, {name: KINDS[name] for name in fine}, LENGTH, False)
    assert sizes == pytest.approx({"turning": 0.3})
    assert gaps == pytest.approx({"turning": 0.01})
