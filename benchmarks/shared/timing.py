"""Repeated timing of an action; that of the steps of a run is `mbs.simulation.step_time`."""

import time
from collections.abc import Callable

from mbs.simulation.step_time import step_time as step_time


def best_time(action: Callable[[], float | None], repeats: int = 5, warm_up: int = 1) -> float:
    """Least time of an action, s, on the wall unless it measures itself: what else the machine does can only add to it.

    Parameters
    ----------
    action : callable
        Is run `warm_up + repeats` times. It may return the time it measured itself, s, to leave its preparations out.
    repeats, warm_up : int
        Measured and unmeasured runs.
    """
    walls = []
    for k in range(warm_up + repeats):
        begin = time.perf_counter()
        measured = action()
        wall = time.perf_counter() - begin if measured is None else measured
        if k >= warm_up:
            walls.append(wall)
    return min(walls)
