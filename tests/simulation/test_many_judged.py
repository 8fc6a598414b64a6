"""`simulate_many` warns of the runs that `simulate` warns of, in its words."""

import warnings
from collections import Counter

import pytest

import mbs
from mbs.scenes import double_four_bar

Told = Counter[tuple[type[Warning], str]]


def told_by_each(system: mbs.System, variants: list[mbs.Variant], t_end: float, h: float, every: int) -> list[Told]:
    """Warnings of the runs made one by one."""
    results = []
    for variant in variants:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            mbs.simulate(
                system, t_end, h, variant.inputs, parameters=variant.parameters, pose=variant.pose, every=every,
                progress=False,
            )  # fmt: skip
        results.append(Counter((w.category, str(w.message)) for w in caught))
    return results


def told_together(system: mbs.System, variants: list[mbs.Variant], t_end: float, h: float, every: int) -> list[Told]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        mbs.simulate_many(system, variants, t_end, h, every=every, progress=False)
    results: list[Told] = [Counter() for _ in variants]
    for w in caught:
        number, _, text = str(w.message).removeprefix("Variant ").partition(": ")
        results[int(number)][w.category, text] += 1
    return results


def test_a_mechanism_that_swings_too_fast() -> None:
    system = mbs.compile(double_four_bar.build())
    variants = [mbs.Variant(), mbs.Variant()]
    each = told_by_each(system, variants, 3.0, 0.05, 1)
    assert told_together(system, variants, 3.0, 0.05, 1) == each
    assert any(kind is mbs.AccuracyWarning for warnings in each for kind, _ in warnings)


def test_without_checks_nothing_is_repeated_and_true_is_refused() -> None:
    system = mbs.compile(double_four_bar.build())
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        runs = mbs.simulate_many(system, [mbs.Variant()], 0.2, 0.01, progress=False, estimate_error=False)
    assert runs.trajectories[0] is not None
    assert runs.trajectories[0].accuracy is not None
    assert runs.trajectories[0].accuracy.compared_step is None
    with pytest.raises(ValueError, match="estimate_error = True; many runs"):
        mbs.simulate_many(system, [mbs.Variant()], 0.2, 0.01, progress=False, estimate_error=True)
