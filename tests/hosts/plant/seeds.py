"""Checks of the seeds of an environment of Gymnasium."""

import gymnasium
import numpy as np


def check_seeds(name: str, **options: str) -> None:
    """Equal seeds give equal episodes, other seeds other ones."""
    episodes = []
    for seed in (3, 3, 4):
        with gymnasium.make(name, **options) as env:
            rows = [env.reset(seed=seed)[0]]
            env.action_space.seed(1)
            rows += [env.step(env.action_space.sample())[0] for _ in range(10)]
            episodes.append(np.array(rows))
    assert (episodes[0] == episodes[1]).all()
    assert (episodes[0] != episodes[2]).any()
