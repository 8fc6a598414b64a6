"""The stored motions are those that their command computes."""

import numpy as np
import pytest

from benchmarks.references.cases import SLOW, computed, exact_of


@pytest.mark.proof
@pytest.mark.parametrize("name", SLOW)
def test_a_stored_motion_is_made_again(name: str) -> None:
    stored = exact_of(name)
    assert np.ptp(stored, axis=0).max() > 0.01
    assert np.abs(computed(name) - stored).max() < 1e-8
