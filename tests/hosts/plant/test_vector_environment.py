"""Environments on threads: the bits of the same ones in sequence, with Gymnasium's seeds and resets."""

import threading
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import data_equivalence
from gymnasium.vector import AutoresetMode, SyncVectorEnv

import hosts.plant.environments  # noqa: F401, registers them
from hosts.common.errors import HostError
from hosts.plant.environments import LaneKeeping
from hosts.plant.vector_environment import VectorEnvironment
from tests.quick import quick

LANE, BRAKES, LAP = (f"ali3/{name}-v0" for name in ("LaneKeeping", "AntiLockBraking", "ProvingGroundLap"))
MANY = 3
STEPS = 24


@pytest.fixture(params=quick((LANE,), (LANE, BRAKES, LAP)))
def named(request: pytest.FixtureRequest) -> tuple[str, dict[str, Any]]:
    """An environment that is cut after eight steps, so that new starts are among those that are compared."""
    path = request.getfixturevalue("braked_fmu" if request.param == BRAKES else "rigid_fmu")
    step = 0.01 if request.param == BRAKES else 0.02
    more = {"road": "plane.road"} if request.param == LAP else {}
    return request.param, {"car": str(path), "seconds": 8 * step, **more}


def test_they_are_single_ones_to_the_last_bit(named: tuple[str, dict[str, Any]]) -> None:
    name, options = named
    several = gymnasium.make_vec(name, MANY, threads=2, **options)
    assert isinstance(several, VectorEnvironment)
    singles = [gymnasium.make(name, **options) for _ in range(MANY)]
    several.action_space.seed(1)
    observation = several.reset(seed=7)[0]
    alone = [single.reset(seed=7 + k)[0] for k, single in enumerate(singles)]
    assert (observation == np.array(alone)).all()
    ended, starts = [False] * MANY, 0
    for _ in range(STEPS):
        actions = several.action_space.sample()
        observation, reward, terminated, cut, _ = several.step(actions)
        for k, single in enumerate(singles):
            if ended[k]:  # the step after an end is the new start
                row = (single.reset()[0], 0.0, False, False)
                starts += 1
            else:
                row = single.step(actions[k])[:4]
            assert (observation[k] == row[0]).all()
            assert (reward[k], terminated[k], cut[k]) == row[1:]
            ended[k] = bool(row[2] or row[3])
    assert starts >= 2 * MANY
    several.close()
    for single in singles:
        single.close()


@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_new_starts_are_those_of_gymnasium(rigid_fmu: Path, mode: AutoresetMode) -> None:
    """Each way of Gymnasium to start again: the same numbers, ends and further words."""

    def make() -> LaneKeeping:
        return LaneKeeping(str(rigid_fmu), seconds=0.1)

    rows: list[list[Any]] = []
    for kind, more in ((SyncVectorEnv, {}), (VectorEnvironment, {"threads": 2})):
        result = kind([make] * 3, autoreset_mode=mode, **more)
        result.action_space.seed(1)
        mine: list[Any] = [result.reset(seed=[3, 1, 4])]
        for _ in range(12):
            mine.append(result.step(result.action_space.sample()))
            if mode == AutoresetMode.DISABLED and (ended := mine[-1][2] | mine[-1][3]).any():
                mine.append(result.reset(options={"reset_mask": ended}))
        rows.append(mine)
        result.close()
    assert len(rows[0]) == len(rows[1])
    for one, other in zip(*rows, strict=True):
        assert data_equivalence(one, other, exact=True)


def test_steps_are_under_way_at_once(rigid_fmu: Path) -> None:
    """Steps that wait for another one end, so two are made at once; what one raises is raised, and all go on."""
    result = gymnasium.make_vec(LANE, 4, threads=2, car=str(rigid_fmu))
    assert isinstance(result, VectorEnvironment)
    result.reset(seed=0)
    meeting = threading.Barrier(2, timeout=20.0)
    for env in result.envs:
        car = env.unwrapped.car
        car.step = lambda inputs, inner=car.step: (meeting.wait(), inner(inputs))[1]
    result.step(np.zeros((4, 1), np.float32))
    with pytest.raises(HostError, match="must be 1 finite numbers"):
        result.step(np.array([[0.0], [0.0], [np.nan], [np.nan]], np.float32))
    observation, *_ = result.step(np.zeros((4, 1), np.float32))
    assert np.isfinite(observation).all()
    result.close()


def test_an_invalid_number_of_threads_is_refused_in_one_sentence(rigid_fmu: Path) -> None:
    for threads in (0, 1.5):
        with pytest.raises(HostError, match="whole number from 1"):
            gymnasium.make_vec(LANE, 2, threads=threads, car=str(rigid_fmu))
    for functions in ([], [5]):
        with pytest.raises(HostError, match="they must be a list of functions, each makes one"):
            VectorEnvironment(functions)  # type: ignore[arg-type]
    with pytest.raises(HostError, match="number of environments is 0; it must be a whole number from 1"):
        gymnasium.make_vec(LANE, 0, car=str(rigid_fmu))
    result = gymnasium.make_vec(LANE, 2, car=str(rigid_fmu))
    result.reset(seed=0)
    for actions in (None, np.zeros((3, 1), np.float32)):
        with pytest.raises(HostError, match="they must be 2, one an environment"):
            result.step(actions)
    result.close()
    with pytest.raises(HostError, match="The environments are closed"):
        result.step(np.zeros((2, 1), np.float32))
