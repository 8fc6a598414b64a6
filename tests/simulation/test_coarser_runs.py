"""The coarser runs that a run is compared with: which ones, and that they do not make a wrong run right."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import mbs
from benchmarks.methods import random_mechanisms
from benchmarks.references.cases import system_of
from mbs.results.accuracy import Accuracy
from mbs.results.two_repeats import by_two_repeats


@pytest.mark.parametrize(
    ("h", "cost", "more"),
    [
        pytest.param(0.016, 0.625, {}, id="eight times is too far off"),
        pytest.param(0.005, 0.5, {"method": "energy_momentum"}, id="iterations cannot be limited"),
        pytest.param(0.005, 0.5, {"settings": mbs.Settings(step_iterations=4)}, id="they are limited already"),
    ],
)
def test_a_right_run_may_need_one_of_twice_the_step(h: float, cost: float, more: dict[str, Any]) -> None:
    run = mbs.simulate(system_of("pendulum"), 10.0, h, progress=False, **more)
    assert run.accuracy is not None
    assert run.accuracy.repeated_with == 2.0 * h
    assert run.accuracy.repeat_cost == cost
    assert not run.accuracy.message


def test_long_steps_that_are_solved_to_the_end_would_hide_it() -> None:
    """A spatial slider-crank, a third off: steps eight times as long are halved, and then differ by 8 %."""
    rng = np.random.default_rng([5, 244])
    rng.random()  # which decides between mechanism and car
    kind, drawing = random_mechanisms.drawing(rng)
    assert kind == "spatial slider-crank"
    system = mbs.compile(random_mechanisms.model_of(drawing))
    with pytest.warns(mbs.AccuracyWarning, match="off by at least 3[0-9] %"):
        mbs.simulate(system, drawing.span, drawing.span / 300, every=6, progress=False)


@pytest.mark.parametrize("ratio", [2.0, 2.5])
@pytest.mark.parametrize(("order", "used"), [(2.0, 2.0), (1.4, 2.0), (1.1, 1.1), (0.8, 0.8), (0.5, 0.75)])
def test_two_repeats_show_an_order_far_below_that_of_the_method(order: float, used: float, ratio: float) -> None:
    """Of an error of 1 that falls with h^order each repeat shows what it lacks of it, as of order two."""
    apart = [1.0 - r**-order for r in (ratio, 2.0 * ratio)]
    known = [
        Accuracy(None, None, 0.0, r, 2.0, 2.0, {"m": d / (1.0 - r**-2.0)}, {"x": 3.0 * d / (1.0 - r**-2.0)})
        for r, d in zip((ratio, 2.0 * ratio), apart, strict=True)
    ]
    found = by_two_repeats(*known, ratio)
    assert found.order == pytest.approx(used, abs=1e-3)
    assert found.error == pytest.approx(apart[1] / (1.0 - (2.0 * ratio) ** -used), rel=1e-3)
    assert found.sensors["x"] == pytest.approx(3.0 * found.units["m"])


def test_an_error_that_falls_slowly_is_told() -> None:
    """A four-bar with a pendulum, 5.9 % off: half and a quarter of the step differ from it by 2.7 and 4.1 %."""
    rng = np.random.default_rng([3, 29])
    rng.random()
    _, drawing = random_mechanisms.drawing(rng)
    system = mbs.compile(random_mechanisms.model_of(drawing))
    with pytest.warns(mbs.AccuracyWarning, match=r"off by about 5\.[5-9] %"):
        mbs.simulate(system, drawing.span, drawing.span / 150, every=3, progress=False)
