"""Runs that are too coarse on purpose."""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager

import mbs


@contextmanager
def expected_errors() -> Iterator[None]:
    """Runs whose steps or models are too coarse, or values unworkable, on purpose: what they say is known."""
    with warnings.catch_warnings():
        for category in (mbs.AccuracyWarning, mbs.BendingWarning, mbs.BranchWarning, mbs.ParameterWarning):
            warnings.simplefilter("ignore", category)
        yield
