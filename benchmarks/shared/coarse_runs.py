"""A context without warnings, for runs that are too coarse on purpose."""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager

import mbs


@contextmanager
def expected_errors() -> Iterator[None]:
    """Suppress warnings of runs whose steps or models are too coarse, or values unusual, on purpose."""
    with warnings.catch_warnings():
        for category in (mbs.AccuracyWarning, mbs.BendingWarning, mbs.BranchWarning, mbs.ParameterWarning):
            warnings.simplefilter("ignore", category)
        yield
