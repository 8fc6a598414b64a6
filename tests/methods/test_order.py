"""Order of convergence of every method, fitted on four steps."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.references.motions import four_bar as exact
from mbs import Settings, compile, simulate
from mbs.scenes import bricard, double_four_bar
from tests.methods.models import driven, end, hinge, swing

TIGHT = {"tolerance_r": 1e-12, "tolerance_phi": 1e-13}


def fitted(errors, steps):
    return float(np.polyfit(np.log(steps), np.log(errors), 1)[0])


def errors_against_fine(system, names, t_end, steps, fine, settings):
    reference = end(system, names, t_end, *fine)
    return np.array([np.linalg.norm(end(system, names, t_end, h, settings) - reference) for h in steps])


@pytest.mark.parametrize("method", ["ali3p", "ali3p_generalised_alpha", "energy_momentum"])
@pytest.mark.parametrize(
    ("model", "names"), [(swing(6.0), ["tip.y"]), (hinge(0.3), ["angle"]), (driven(), ["bob.x", "bob.y"])]
)
def test_order_two_with_dampers_angles_and_drives(method, model, names):
    steps = np.array([0.02, 0.01, 0.005, 0.0025])
    fine = (0.0003125, Settings(**TIGHT))
    errors = errors_against_fine(compile(model), names, 1.0, steps, fine, Settings(method=method, **TIGHT))
    assert 1.75 < fitted(errors, steps) < 2.25


@pytest.mark.parametrize(
    ("model", "names", "t_end"),
    [(bricard.build(), [f"P3.position.{c}" for c in "xyz"], 2.0), (swing(0.0), ["tip.y"], 1.0)],
)
def test_order_four_by_composition_where_nothing_dissipates(model, names, t_end):
    steps = np.array([0.04, 0.02, 0.01, 0.005]) * t_end
    four = Settings(method="energy_momentum_4", **TIGHT)
    errors = errors_against_fine(compile(model), names, t_end, steps, (0.00125 * t_end, four), four)
    assert 3.7 < fitted(errors, steps) < 4.3


def test_order_four_through_singular_positions_to_the_figures_of_the_dense_trial():
    """0.1 / 0.05 s: 3.7e-3 / 2.6e-4 m after ten crossings."""
    system, t = compile(double_four_bar.build()), np.arange(0.0, 10.0001, 0.1)
    expected = exact(2, t)
    worst = []
    for h in (0.1, 0.05, 0.025):
        run = simulate(system, 10.0, h, method="energy_momentum_4", every=round(0.1 / h))
        place = np.column_stack([run["B0.position.x"], run["B0.position.y"]])
        worst.append(np.linalg.norm(place - expected, axis=1).max())
        assert np.abs(run["energy.total"] - run["energy.total"][0]).max() < 1e-6
    assert worst[0] < 5e-3
    assert worst[1] < 3.5e-4
    assert worst[2] < 2.5e-5
