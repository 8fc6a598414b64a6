"""Limits of the attacks on readers: random seeds, which are printed, time and memory."""

import os
import random
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

_COUNT = int(os.environ.get("ALI3_ATTACKS", "0"))
"""Attacks of each kind; 0: as many as 0.2 s allow."""
_MEMORY = 2 * 10**9  # bytes beyond what is held before


def seeds(kind: str) -> Iterator[int]:
    """Seeds from one by chance on; it is printed, and so is at the end how many there were."""
    first = random.SystemRandom().randrange(2**40)
    end, count = 0.0, 0
    print(f"{kind}: seeds from {first} on")
    while count < (_COUNT or 2000) and (not count or time.monotonic() < end):
        yield first + count
        if not count:  # with what is imported by the first
            end = time.monotonic() + (900.0 if _COUNT else 0.2)
        count += 1
    print(f"{kind}: {count}")
    assert count


def kills() -> int:
    """How many kills of one kind: one, or thirty."""
    return 30 if _COUNT else 1


@contextmanager
def little_memory() -> Iterator[None]:
    """This process gets no more than `_MEMORY`."""
    resource = pytest.importorskip("resource")
    limits = resource.getrlimit(resource.RLIMIT_AS)
    used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + _MEMORY, limits[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, limits)
