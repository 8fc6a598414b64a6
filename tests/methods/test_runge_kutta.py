"""The explicit method of order eight: what it reaches, and what it does not take."""

from __future__ import annotations

import numpy as np
import pytest

from mbs import Settings, SimulationError, compile, simulate
from mbs.scenes import bricard, prototype_car, spatial_chain
from tests.methods.models import assert_saved_state_continues, driven, end, swing

TIGHT = Settings(method="runge_kutta_8", tolerance_phi=1e-14)
TWELVE = 12  # evaluations a step


@pytest.mark.parametrize(
    ("model", "names", "t_end", "steps"),
    [
        (bricard.build(), [f"P3.position.{c}" for c in "xyz"], 2.0, (0.4, 0.25, 0.2, 0.125)),
        (swing(6.0), ["tip.y"], 1.0, (0.1, 0.0625, 0.05, 0.04)),
        (spatial_chain.build(), [f"tip.position.{c}" for c in "xyz"], 1.0, (0.05, 0.04, 0.03125, 0.025)),
    ],
    ids=["Bricard", "damped swing", "chain"],
)
def test_order_eight_with_redundant_rows_dampers_and_trees(model, names, t_end, steps):
    system = compile(model)
    reference = end(system, names, t_end, 0.1 * steps[-1], TIGHT)
    errors = [np.linalg.norm(end(system, names, t_end, h, TIGHT) - reference) for h in steps]
    assert np.polyfit(np.log(steps), np.log(errors), 1)[0] > 6.5
    assert errors[-1] < 1e-5


def test_it_agrees_with_the_implicit_steps_also_where_a_guide_drives():
    system, names = compile(driven()), ["bob.x", "bob.y"]
    expected = end(system, names, 2.0, 0.0005, Settings())
    np.testing.assert_allclose(end(system, names, 2.0, 0.02, TIGHT), expected, atol=2e-5)


def test_the_rows_and_their_rates_hold_and_a_step_costs_twelve_evaluations():
    run = simulate(compile(bricard.build()), 5.0, 0.1, settings=TIGHT)
    assert run.report.violation < 1e-12
    assert run.report.velocity_violation < 1e-10
    assert run.report.iterations == TWELVE * run.report.steps
    assert np.abs(run["energy.total"] - run["energy.total"][0]).max() < 1e-6


def test_a_saved_state_continues_bit_for_bit():
    assert_saved_state_continues(compile(swing(2.0)), TIGHT)


def test_element_states_are_refused():
    with pytest.raises(SimulationError, match="takes no element states"):
        simulate(compile(prototype_car.build()), 0.1, 0.01, method="runge_kutta_8")
