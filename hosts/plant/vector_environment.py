"""Several environments of Gymnasium beside each other, each step on threads: `gymnasium.make_vec(NAME, 8)`."""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, wait
from functools import partial
from typing import Any

import gymnasium
from gymnasium.vector import AutoresetMode, SyncVectorEnv

from ali3.cores import available_cores
from ali3.message_text import brief
from hosts.common.errors import HostError
from hosts.plant.environments import AntiLockBraking, Floats, LaneKeeping
from hosts.plant.lap import ProvingGroundLap

_Single = gymnasium.Env[Floats, Floats]


class _Ahead(gymnasium.Wrapper[Floats, Floats, Floats, Floats]):
    """An environment that a thread steps ahead; later calls of `step` and `reset` return these results."""

    def __init__(self, env: _Single) -> None:
        super().__init__(env)
        self._ended = False
        self._results: list[Any] = []  # of the next calls; an exception is raised there

    def ahead(self, action: Floats, autoreset: AutoresetMode) -> None:
        """Make the calls of `SyncVectorEnv.step` for an environment: a step, a new start, or both."""
        self._results = []
        try:
            if self._ended and autoreset == AutoresetMode.NEXT_STEP:
                self._results = [self._start()]
                return
            self._results = [self._advance(action)]
            if self._ended and autoreset == AutoresetMode.SAME_STEP:
                self._results.append(self._start())
        except BaseException as error:
            self._results.append(error)

    def step(self, action: Floats) -> Any:
        return self._next_result() if self._results else self._advance(action)

    def reset(self, **options: Any) -> Any:
        return self._next_result() if self._results else self._start(**options)

    def _next_result(self) -> Any:
        result = self._results.pop(0)
        if isinstance(result, BaseException):
            raise result
        return result

    def _advance(self, action: Floats) -> Any:
        transition = self.env.step(action)
        self._ended = bool(transition[2] or transition[3])
        return transition

    def _start(self, **options: Any) -> Any:
        start = self.env.reset(**options)
        self._ended = False
        return start


class VectorEnvironment(SyncVectorEnv[Floats, Floats]):
    """Environments beside each other, as `gymnasium.vector.SyncVectorEnv`, whose steps and new starts run on threads.

    The slave in C of a car leaves Python's lock while it steps, so that cars advance on all cores; what an environment
    computes in Python remains one after the other. Seeds, spaces, autoreset and bits are those of `SyncVectorEnv`.

    Parameters
    ----------
    env_fns : sequence of callable
        Each makes an environment.
    threads : int, optional
        By default one for each environment, at most as many as there are cores.
    **options
        Of `SyncVectorEnv`.
    """

    def __init__(self, env_fns: Sequence[Callable[[], _Single]], threads: int | None = None, **options: Any) -> None:
        if not (isinstance(env_fns, Sequence) and env_fns and all(map(callable, env_fns))):
            raise HostError(f"The environments are {brief(env_fns)}; they must be a list of functions, each makes one.")
        if threads is not None and not (isinstance(threads, int) and threads >= 1):
            raise HostError(f"The number of threads is {threads!r}; it must be a whole number from 1.")
        super().__init__([lambda make=make: _Ahead(make()) for make in env_fns], **options)  # type: ignore[misc]
        self._threads = min(self.num_envs, threads or available_cores())
        self._pool = ThreadPoolExecutor(self._threads)

    def step(self, actions: Any) -> Any:
        """A step of each; see `gymnasium.vector.VectorEnv.step`."""
        if self.closed:
            raise HostError("The environments are closed; make other ones.")
        if not (hasattr(actions, "__len__") and getattr(actions, "shape", True) and len(actions) == self.num_envs):
            raise HostError(f"The actions are {brief(actions)}; they must be {self.num_envs}, one an environment.")
        pairs = list(zip(self.envs, gymnasium.vector.utils.iterate(self.action_space, actions), strict=True))

        def step_share(first: int) -> None:
            for env, action in pairs[first :: self._threads]:
                env.ahead(action, self.autoreset_mode)  # type: ignore[attr-defined]

        futures = [self._pool.submit(step_share, first) for first in range(1, self._threads)]
        step_share(0)
        wait(futures)
        return super().step(actions)

    def close_extras(self, **options: Any) -> None:
        """End the threads, free the cars."""
        self._pool.shutdown()
        super().close_extras(**options)


def _vector_of(environment: Callable[..., _Single], num_envs: int, **options: Any) -> VectorEnvironment:
    """Environments of one kind with its options, those of `VectorEnvironment` beside them."""
    if not isinstance(num_envs, int) or num_envs < 1:
        raise HostError(f"The number of environments is {brief(num_envs)}; it must be a whole number from 1.")
    vector_options = {name: options.pop(name) for name in ("threads", "autoreset_mode", "copy") if name in options}
    return VectorEnvironment(num_envs * [partial(environment, **options)], **vector_options)


lane_keeping = partial(_vector_of, LaneKeeping)
anti_lock_braking = partial(_vector_of, AntiLockBraking)
proving_ground_lap = partial(_vector_of, ProvingGroundLap)
