"""The coarser runs that a run is compared with: which ones, and that they do not make a wrong run right."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import mbs
from benchmarks.methods import random_mechanisms
from benchmarks.references.cases import system_of


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


def test_an_error_that_falls_slowly_is_told() -> None:
    """A four-bar with a pendulum, 5.9 % off: half and a quarter of the step differ from it by 2.7 and 4.1 %."""
    rng = np.random.default_rng([3, 29])
    rng.random()
    _, drawing = random_mechanisms.drawing(rng)
    system = mbs.compile(random_mechanisms.model_of(drawing))
    with pytest.warns(mbs.AccuracyWarning, match=r"off by about (5\.[5-9]|6) %"):
        mbs.simulate(system, drawing.span, drawing.span / 150, every=3, progress=False)
