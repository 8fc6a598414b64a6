"""Work of a steering whose input jumps and is held, at a usual step and at a tenth of it."""

import numpy as np
import pytest

from mbs import Pose, Simulation, compile
from mbs.vehicle import car_names, load

EDGES = np.arange(0.5, 3.0, 0.2)
LEVELS = np.concatenate([[0.0], 0.2 * (-1.0) ** np.arange(len(EDGES))])
SQUARE = np.repeat(np.concatenate([[0.0], EDGES, [3.0]]), 2)[1:-1], np.repeat(LEVELS, 2)
BOUND = {"ferrari_250_lm": 0.035}
"""Its column rings for half a period; the error of the steps, 1.95 % of the largest work, tells that."""


@pytest.mark.slow
@pytest.mark.parametrize("name", car_names())
def test_the_work_of_the_steering_is_that_of_a_tenth_of_the_step(name):
    model = load(name).model()
    model.sense_solver("error", "energy_error")
    system = compile(model)

    def run(h):
        return Simulation(system, pose=Pose(speed=20.0)).run(3.0, h, inputs={"steering": SQUARE}, progress=False)

    coarse, fine = run(2e-3), run(2e-4)
    work = fine["energy.steering"][::10]
    largest = np.abs(work).max()
    assert largest > 20.0  # J
    assert np.abs(coarse["energy.steering"] - work).max() < BOUND.get(name, 0.02) * largest
    assert np.abs(coarse["error"]).max() < 0.02 * largest
