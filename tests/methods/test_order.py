"""Order of convergence of the methods, fitted on four steps; of relative coordinates in `test_semi_recursive.py`."""

import numpy as np
import pytest

from benchmarks.references.motions import four_bar as exact
from mbs import Settings, compile, simulate
from mbs.scenes import bricard, double_four_bar, flyball, spatial_chain
from tests.methods.models import driven, end, hinge, swing

SECOND_ORDER = ("ali3p", "ali3p_generalised_alpha", "energy_momentum")
TIGHT = {"tolerance_r": 1e-13, "tolerance_phi": 1e-13}
PLACE = [f"P3.position.{c}" for c in "xyz"]
SECOND = (0.02, 0.01, 0.005, 0.0025)
FIFTH = (0.05, 0.04, 0.025, 0.02)
DAMPED, HINGE, DRIVEN = (swing(6.0), ["tip.y"]), (hinge(0.3), ["angle"]), (driven(), ["bob.x", "bob.y"])
LOOP, CHAIN = (bricard.build(), PLACE), (spatial_chain.build(), [f"tip.position.{c}" for c in "xyz"])
CASES = [
    # method, model and its sensors, end in s, steps in s, bounds of the order, largest error at the finest step
    *((m, *case, 1.0, SECOND, 1.75, 2.25, 1e-3) for m in SECOND_ORDER for case in (DAMPED, HINGE, DRIVEN)),
    ("energy_momentum_4", *LOOP, 2.0, (0.08, 0.04, 0.02, 0.01), 3.7, 4.3, 1e-5),
    ("energy_momentum_4", swing(0.0), ["tip.y"], 1.0, (0.04, 0.02, 0.01, 0.005), 3.7, 4.3, 1e-5),
    *(("radau_5", *case, 1.0, FIFTH, 4.5, 7.0, 1e-6) for case in (DAMPED, HINGE, DRIVEN)),
    ("radau_5", *LOOP, 10.0, (0.1, 0.0625, 0.05, 0.04), 4.5, 7.0, 1e-6),
    ("radau_5", flyball.build(), ["shaft.rate"], 2.0, (0.04, 0.025, 0.02, 0.0125), 4.5, 7.0, 1e-6),
    ("runge_kutta_8", *LOOP, 2.0, (0.4, 0.25, 0.2, 0.125), 6.5, 10.0, 1e-5),
    ("runge_kutta_8", *DAMPED, 1.0, (0.1, 0.0625, 0.05, 0.04), 6.5, 10.0, 1e-5),
    ("runge_kutta_8", *CHAIN, 1.0, (0.05, 0.04, 0.03125, 0.025), 6.5, 10.0, 1e-5),
]


@pytest.mark.parametrize(
    ("method", "model", "names", "t_end", "steps", "least", "most", "error"),
    CASES,
    ids=[f"{method}-{model.name}" for method, model, *_ in CASES],
)
def test_errors_fall_with_the_order_of_the_method(method, model, names, t_end, steps, least, most, error):
    """Against the method itself in steps of a tenth; those of order two against one of order five."""
    system, settings = compile(model), Settings(method=method, **TIGHT)
    second = method in SECOND_ORDER
    fine = (steps[-1], Settings(method="radau_5", **TIGHT)) if second else (0.1 * steps[-1], settings)
    reference = end(system, names, t_end, *fine)
    errors = [np.linalg.norm(end(system, names, t_end, h, settings) - reference) for h in steps]
    assert least < np.polyfit(np.log(steps), np.log(errors), 1)[0] < most
    assert errors[-1] < error


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
