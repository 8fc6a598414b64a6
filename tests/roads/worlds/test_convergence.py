"""The grid of the proving ground is fine enough: a finer one gives the same tyre loads."""

import numpy as np
import pytest

import mbs
from mbs.elements import GridRoad
from mbs.roads import write_road
from mbs.worlds.make_world import read_world
from mbs.worlds.obstacles import added_height
from tests.roads.worlds.test_proving_ground import FILE


def loads(car, obstacle, spacing, speed, folder):
    """Largest loads of a front and a rear tyre over an obstacle of the world alone."""
    x = obstacle.at[0] - 20.0 + spacing * np.arange(round(60.0 / spacing)) + 0.37 * spacing
    heights = added_height(obstacle, x, np.full(len(x), obstacle.at[1]))
    road = GridRoad((float(x[0]), -20.0), (spacing, 40.0), np.repeat(heights[:, None], 2, axis=1), 0.9)
    write_road(road, folder / "a.road")
    pose = mbs.Pose(obstacle.at[0] - 6.0, 0.0, 0.0, 0.0, speed)
    run = mbs.simulate(car, 22.0 / speed, 0.002, pose=pose, parameters={"road.file": folder / "a.road"}, progress=False)
    return np.array([run["wheel_FL.Fz"].max(), run["wheel_RL.Fz"].max()])


@pytest.mark.slow
@pytest.mark.parametrize(("number", "speeds"), [(0, (5.0, 10.0, 20.0)), (7, (15.0, 25.0))], ids=["kerb", "ramp 1"])
def test_loads_over_kerb_and_ramp_converge(tmp_path, car, number, speeds):
    world = read_world(FILE)
    obstacle = world.obstacles[number]
    assert (obstacle.kind, obstacle.height) == (("kerb", 0.08), ("ramp", 1.0))[number > 0]
    for speed in speeds:
        taken, half, finest = (
            loads(car, obstacle, d, speed, tmp_path) for d in (world.spacing[0], 0.5 * world.spacing[0], 0.0125)
        )
        print(obstacle.kind, speed, taken.round(), half.round(), finest.round())
        assert finest.max() > 2500.0
        assert np.abs(taken / finest - 1.0).max() < 0.015
        assert np.abs(half / finest - 1.0).max() < 0.008
