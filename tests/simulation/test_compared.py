"""The comparison of two motions in the kernel, which FMUs use, is that of Python."""

from __future__ import annotations

from collections.abc import Mapping
from ctypes import POINTER, c_double
from typing import Any

import numpy as np
import pytest

from fmu_src.native.table import JUDGED_UNITS, kind_of
from mbs.kernel.binding import load_library
from mbs.kernel.header.structures import ComparedFields, JudgedFields
from mbs.results import comparison
from mbs.results.comparison import Array, Compared, compared_in

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


def compared(
    coarse: Mapping[str, Array], fine: Mapping[str, Array], judged: Mapping[str, Compared], length: float, guided: bool
) -> tuple[dict[str, float], dict[str, float]]:
    """What two motions differ by at their samples, and what that is held against.

    Parameters
    ----------
    coarse, fine : mapping of str to array of shape (n,)
        By name, at the same samples; sizes are those of the finer one.
    judged : mapping of str to Compared
        What is compared.
    length : float
        Of the model, m.
    guided : bool
        Whether places that are the same in both do not move by themselves.

    Returns
    -------
    gaps : dict of str to float
        Largest differences.
    sizes : dict of str to float
        Of those that count.
    """
    names, library = list(judged), load_library()
    what = (JudgedFields * len(names))(*(JudgedFields(JUDGED_UNITS[w.unit], kind_of(w)) for w in judged.values()))
    seen, size = (ComparedFields * len(names))(), np.zeros(len(names))
    rows = [np.column_stack([np.asarray(run[name], float) for name in names]) for run in (coarse, fine)]
    time, *motions = (_doubles(np.ascontiguousarray(a)) for a in (np.arange(float(len(rows[0]))), *rows))
    library.ali3_compare(what, len(names), len(rows[0]), time, *motions, seen)
    library.ali3_compared_sizes(what, len(names), seen, length, guided, _doubles(size))
    sizes = {name: float(of) for name, of in zip(names, size, strict=True) if of > 0.0}
    return {name: s.gap for name, s in zip(names, seen, strict=True) if name in sizes}, sizes


def _doubles(values: Array) -> Any:
    return values.ctypes.data_as(POINTER(c_double))
