"""Environments of Gymnasium: its checker, seeds, several at once, and a controller."""

from contextlib import closing

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from hosts.common.errors import HostError
from hosts.plant import environments  # registers them
from hosts.plant.lap import ProvingGroundLap
from tests.hosts.plant.seeds import check_seeds

LANE, BRAKES = "ali3/LaneKeeping-v0", "ali3/AntiLockBraking-v0"


@pytest.fixture(params=[LANE, pytest.param(BRAKES, marks=pytest.mark.slow)])
def named(request: pytest.FixtureRequest) -> tuple[str, str]:
    return request.param, request.getfixturevalue("rigid_fmu" if request.param == LANE else "braked_fmu")


def test_they_pass_the_checker(named):
    name, path = named
    result = gymnasium.make(name, car=str(path)).unwrapped
    result.spec = None  # else the checker makes a second one by its name, of the car of the package
    check_env(result, skip_render_check=True)
    result.close()


def test_a_seed_gives_the_same_episode(named):
    name, path = named
    check_seeds(name, car=str(path))


@pytest.mark.slow
def test_the_driver_keeps_the_lane_and_zero_steering_leaves_it(rigid_fmu):
    ends = {}
    for gain in (1.0, 0.0):
        keeping = environments.LaneKeeping(str(rigid_fmu), speed=(12.0, 12.0), seconds=12.0)
        observation, _ = keeping.reset(seed=0)
        ended = departed = False
        while not (ended or departed):
            offset, heading, bend = observation[0], observation[1], observation[6]
            steering = gain * (9.0 * bend - 0.25 * offset - 1.2 * heading)
            observation, _, departed, ended, _ = keeping.step(np.array([steering], np.float32))
        ends[gain] = bool(departed)
        keeping.close()
    assert ends == {1.0: False, 0.0: True}


@pytest.mark.slow
def test_an_invalid_action_is_refused_and_changes_nothing(braked_fmu, rigid_fmu):
    """Ports hold their last values and a car takes the first of several, which a policy that learns would not know."""
    for make, path in ((environments.AntiLockBraking, braked_fmu), (environments.LaneKeeping, rigid_fmu)):
        with closing(make(str(path))) as env:
            shape = env.action_space.shape
            rows = []
            for bad in (False, True):
                env.reset(seed=1)
                for action in (np.full(shape, np.nan), np.full(shape, -np.inf), np.zeros(7), "x", None) if bad else ():
                    with pytest.raises(HostError, match=f"must be {shape[0]} finite numbers"):
                        env.step(action)
                rows.append(env.step(np.full(shape, 0.5, np.float32)))
            assert (rows[0][0] == rows[1][0]).all()
            assert rows[0][1] == rows[1][1]


def test_options_of_a_reset_are_parameters_of_that_start(rigid_fmu):
    with closing(environments.LaneKeeping(str(rigid_fmu))) as env:
        drawn, _ = env.reset(seed=1)
        observation, _ = env.reset(seed=1, options={"initial.speed": 10.0, "road.friction": (0.4, 0.5)})
        assert observation[2] == pytest.approx(10.0, rel=1e-3)
        assert 0.4 < env.car.read(("road.friction",))[0] < 0.5
        with pytest.raises(HostError, match="The options of a start are 5; they must be a dictionary"):
            env.reset(seed=1, options=5)
        with pytest.raises(HostError, match=r"no parameter or input 'speed'"):
            env.reset(seed=1, options={"speed": 10.0})
        again, _ = env.reset(seed=1)
        assert (again == drawn).all()


@pytest.mark.parametrize(
    ("made", "options", "message"),
    [
        (environments.LaneKeeping, {"speed": 12.0}, "speeds at the start of an environment are 12.0; they must be two"),
        (environments.AntiLockBraking, {"torque": (np.nan, 5.0)}, "torques of the brakes of an environment are"),
        (ProvingGroundLap, {"speed": (1.0, 2.0, 3.0), "road": "plane.road"}, "speeds at the start"),
        (environments.LaneKeeping, {"seconds": 0}, "An episode has 0 s; it must be a number, and a step or more."),
    ],
)
def test_an_environment_that_cannot_be_is_one_sentence(made, options, message, rigid_fmu):
    with pytest.raises(HostError, match=message):
        made(str(rigid_fmu), **options)


@pytest.mark.slow
def test_brakes_that_let_go_stop_earlier_than_locked_ones(braked_fmu):
    ways = {}
    for controlled in (True, False):
        braking = environments.AntiLockBraking(str(braked_fmu), speed=(15.0, 15.0), friction=(0.5, 0.5))
        observation, _ = braking.reset(seed=0)
        action, distance, ended, cut = np.zeros(4, np.float32), 0.0, False, False
        while not (ended or cut):
            slips = -observation[1:5]
            change = np.where(slips > 0.1, -0.2, 0.05) if controlled else 0.2
            action = np.clip(action + change, 0.0, 1.0).astype(np.float32)
            observation, reward, ended, cut, _ = braking.step(action)
            distance -= reward
        assert ended
        ways[controlled] = distance
        braking.close()
    assert ways[True] < 0.97 * ways[False]
