"""The lap of the proving ground: the ring of the world, Gymnasium's checker, seeds, the driver as baseline."""

from pathlib import Path

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from hosts.fmu.fmu import StepRefusedError
from hosts.plant.lap import LapDriver, ProvingGroundLap, ring
from mbs.worlds.make_world import read_world
from mbs.worlds.package_worlds import WORLDS
from tests.hosts.plant.seeds import check_seeds

LAP = "ali3/ProvingGroundLap-v0"
LEVEL = "plane.road"  # of the FMU: the ring as a line on a plane


def test_the_ring_is_that_of_the_world() -> None:
    """Each of its points lies on the straights and arcs of the description, in their order; also the width."""
    (course,) = [course for course in read_world(WORLDS / "proving_ground.toml").courses if course.name == "ring"]
    x, y, yaw = course.start
    expected = []
    for segment in course.segments:
        length = segment.length or np.radians(segment.angle) * segment.radius
        for s in np.linspace(0.0, length, 200):
            turn = 0.0 if segment.length else s / segment.radius
            along = s + 0j if segment.length else 1j * segment.radius * (1.0 - np.exp(1j * turn))
            place = complex(x, y) + along * np.exp(1j * yaw)
            expected.append((place.real, place.imag))
        (x, y), yaw = expected[-1], yaw + turn
    lane = ring()
    assert lane.closed
    assert lane.width == course.width
    ways = np.array([lane.place(*place) for place in expected])
    assert max(abs(lane.sense(*place, 0.0)[0]) for place in expected) < 2e-3
    ahead = np.diff(ways) % lane.length
    assert np.all(ahead < 10.0)
    assert lane.place(0.0, 0.0) % lane.length == pytest.approx(0.0, abs=1e-6)
    assert lane.length == pytest.approx(2.0 * 640.0 + 2.0 * np.pi * 60.0, rel=1e-4)


def test_it_passes_the_checker(rigid_fmu: Path) -> None:
    result = gymnasium.make(LAP, car=str(rigid_fmu), road=LEVEL).unwrapped
    result.spec = None  # else the checker makes a second one by its name, of the car of the package
    check_env(result, skip_render_check=True)
    result.close()


def test_a_seed_gives_the_same_episode(rigid_fmu: Path) -> None:
    check_seeds(LAP, car=str(rigid_fmu), road=LEVEL)


@pytest.mark.slow
def test_beside_the_road_it_ends(rigid_fmu: Path) -> None:
    """Straight on in the first curve: it ends 6 m beside the middle; the rewards are way over 20 m/s less time."""
    lap = ProvingGroundLap(str(rigid_fmu), road=LEVEL, speed=(30.0, 30.0))
    seen, _ = lap.reset(seed=0)
    total, ended, cut = 0.0, False, False
    while not (ended or cut):
        seen, reward, ended, cut, observation = lap.step(np.array([0.0, 0.5], np.float32))
        total += reward
    assert ended
    assert "lap_time" not in observation
    assert seen[0] < -6.0
    assert 620.0 < lap.driven < 700.0
    assert total == pytest.approx(lap.driven / 20.0 - lap.car.time - 20.0, abs=1e-9)
    lap.close()


@pytest.mark.slow
def test_the_driver_makes_a_lap(rigid_fmu: Path) -> None:
    """On the proving ground, within 1 m of the middle; the time is that of his speed, the sum of rewards that of it."""
    lap = ProvingGroundLap(str(rigid_fmu), speed=(20.0, 20.0), step=0.04)
    seen, _ = lap.reset(seed=0)
    driver, total, worst, ended, cut = LapDriver(lap, 20.0), 0.0, 0.0, False, False
    while not (ended or cut):
        seen, reward, ended, cut, observation = lap.step(driver.act(seen))
        total, worst = total + reward, max(worst, abs(float(seen[0])))
    assert worst < 1.5
    assert observation["lap_time"] == pytest.approx(lap.lane.length / 20.0, rel=0.02)
    assert total == pytest.approx(lap.lane.length / 20.0 - observation["lap_time"], abs=0.05)
    lap.close()


def test_a_refused_step_ends_the_lap_with_the_reward_of_leaving_the_road(rigid_fmu: Path, monkeypatch) -> None:
    with gymnasium.make(LAP, car=str(rigid_fmu), road=LEVEL) as env:
        lap = env.unwrapped
        lap.reset(seed=1)

        def refuse(inputs: np.ndarray) -> None:
            raise StepRefusedError("the solver cannot")

        monkeypatch.setattr(lap.car, "step", refuse)
        _, reward, ended, cut, observation = lap.step(np.zeros(2, np.float32))
    assert observation["refused"] == "the solver cannot"
    assert ended
    assert not cut
    assert reward == pytest.approx(-lap.OUT - lap.car.step_length)
