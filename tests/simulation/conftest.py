"""What tests of the checks of a run share."""

import pytest

from mbs.results import judged


@pytest.fixture
def largest_range(monkeypatch):
    """Errors are held against the largest range in a unit: cases were chosen by what the repeats then tell."""
    monkeypatch.setattr(judged, "FLOOR", 1.0)
