"""How many processes are worth running at a time."""

import os


def available_cores() -> int:
    """Cores that this process may use: fewer than the computer has under ``taskset`` or in a part of a cluster."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # not on this system
        return os.cpu_count() or 1
