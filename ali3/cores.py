"""The number of processes to run at a time on this machine."""

import os


def available_cores() -> int:
    """Cores that this process may use: fewer than the computer has under ``taskset`` or in a part of a cluster."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # missing on some systems
        return os.cpu_count() or 1
