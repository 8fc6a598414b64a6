"""Least time of an action over several runs; `step_time` measures the steps of a simulation."""

import time
from collections.abc import Callable

from mbs.simulation.step_time import step_time as step_time


def best_time(action: Callable[[], float | None], repeats: int) -> float:
    """Least time of an action, s: other work of the machine can only lengthen a run.

    Parameters
    ----------
    action : callable
        Called once to warm up and then `repeats` times. Returns a time that it has measured itself, s, or None: then
        the wall time of the call counts.
    repeats : int
        Number of measured runs.
    """
    walls = []
    for k in range(1 + repeats):
        begin = time.perf_counter()
        measured = action()
        wall = time.perf_counter() - begin if measured is None else measured
        if k > 0:
            walls.append(wall)
    return min(walls)
