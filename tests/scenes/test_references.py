"""Scenes against independent reference trajectories (`tests/data/reference`, origin in the first line of each file)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mbs import Settings, compile, simulate
from mbs.scenes import bricard, double_four_bar, pendulum

DATA = Path(__file__).parents[1] / "data" / "reference"
COARSE, FINE = 0.004, 0.001  # s
# where the four-bar is singular, a softer penalty than the default lets the multipliers settle at small steps
SETTINGS = Settings(eps_rel=1e-7)
CASES = {
    # file: (model, sensors, compared up to, largest position error with the fine step, m)
    "pendulum": (pendulum.build, ("bob.position.x", "bob.position.y"), 10.0, 5e-4),
    "four_bar_1": (lambda: double_four_bar.build(1), ("B0.position.x", "B0.position.y"), 10.0, 5e-4),
    "four_bar_2": (lambda: double_four_bar.build(2), ("B0.position.x", "B0.position.y"), 10.0, 5e-4),
    "four_bar_40": (lambda: double_four_bar.build(40), ("B0.position.x", "B0.position.y"), 5.0, 5e-4),
    "bricard": (bricard.build, ("P3.position.x", "P3.position.y", "P3.position.z"), 10.0, 1e-5),
}


def error(name, h):
    """Largest distance from the reference, m."""
    build, sensors, end, _ = CASES[name]
    table = np.loadtxt(DATA / f"{name}.csv", delimiter=",", skiprows=2)
    table = table[table[:, 0] <= end + 1e-9]
    every = round((table[1, 0] - table[0, 0]) / h)
    t = simulate(compile(build()), end, h, settings=SETTINGS, every=every)
    np.testing.assert_allclose(t.t, table[:, 0], rtol=0, atol=1e-9)
    found = np.array([t[s] for s in sensors]).T
    assert np.max(np.ptp(table[:, 1:], axis=0)) > 0.1
    return float(np.max(np.linalg.norm(found - table[:, 1:], axis=1)))


@pytest.mark.parametrize("name", CASES)
def test_scene_follows_its_reference_and_converges_with_the_square_of_the_step(name):
    coarse, fine = error(name, COARSE), error(name, FINE)
    assert fine < CASES[name][3]
    order = np.log(coarse / fine) / np.log(COARSE / FINE)
    assert 1.8 < order < 2.5
