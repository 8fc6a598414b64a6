"""Runs to a tolerance of motions with growing errors: comparisons of two inaccurate runs are not conclusive."""

import numpy as np

import mbs
from tests.simulation.drawn import drawn

TOLERANCE = 1e-2


def test_the_error_of_a_chain_is_within_ten_tolerances() -> None:
    """Two coarse runs are off alike: 11 tolerances off, guessed as 0.6."""
    system, span = drawn("chain", 2, 204)
    times = np.linspace(0.0, span, 51)
    run, true, other = (
        mbs.simulate(system, span, times=times, tolerance=tolerance, method=method, progress=False)
        for method, tolerance in ((None, TOLERANCE), ("runge_kutta_8", 1e-9), ("radau_5", 1e-7))
    )
    assert run.control is not None
    places = [name for name in run.units if name.startswith("tip")]
    sure = max(np.abs(true[n] - other[n]).max() for n in places) / run.control.length
    assert sure < 0.01 * TOLERANCE
    error = max(np.abs(run[n] - true[n]).max() for n in places) / run.control.length
    assert error < 10.0 * TOLERANCE
    assert run.control.kept
