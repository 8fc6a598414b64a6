"""A follower that is given the demand moves as was measured."""

import numpy as np
import pytest
from scipy.signal import lsim

from hosts.compare.replay import follower_demand
from hosts.measures.signal import Signal


def test_the_follower_moves_as_measured() -> None:
    t = np.arange(0.0, 2.0, 0.001)
    w = 2.0 * np.pi * 10.0
    follower = ([w**2], [1.0, 2.0 * w, w**2])
    # With a time constant of 16 ms, it moves as it can only.
    moved = lsim(follower, np.sin(2.0 * np.pi * np.clip(t - 0.3, 0.0, None)), t)[1]
    samples = Signal("x", "1", "x", t[::10], moved[::10])
    demand = follower_demand(samples, 10.0, t)
    again = lsim(follower, demand, t)[1]
    assert again[: len(t) - 10] == pytest.approx(moved[: len(t) - 10], abs=3e-3)
    assert np.abs(lsim(follower, moved, t)[1] - moved).max() > 0.15  # taken as the demand, it is late
    assert (demand[0], demand[-1]) == pytest.approx((moved[0], moved[-10]), abs=1e-12)
