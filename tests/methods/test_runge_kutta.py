"""The explicit method of order eight: its rows and its cost."""

import numpy as np

from mbs import Settings, compile, simulate
from mbs.scenes import bricard

TIGHT = Settings(method="runge_kutta_8", tolerance_phi=1e-14)
TWELVE = 12  # evaluations a step


def test_the_rows_and_their_rates_hold_and_a_step_costs_twelve_evaluations():
    run = simulate(compile(bricard.build()), 5.0, 0.1, settings=TIGHT)
    assert run.report.violation < 1e-12
    assert run.report.velocity_violation < 1e-10
    assert run.report.iterations == TWELVE * run.report.steps
    assert np.abs(run["energy.total"] - run["energy.total"][0]).max() < 1e-6
