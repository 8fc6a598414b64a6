"""Published figures against drives with known results."""

import numpy as np
import pytest

from benchmarks.validation.published_figures import FROM_REST, TOP_SPEED, published_rows


def test_a_constant_acceleration_and_its_end() -> None:
    time = np.arange(0.0, 90.0, 0.01)
    speed = np.minimum(5.0 * time, 285.0 / 3.6)
    first, last = published_rows(time, speed)
    assert first["car"] == pytest.approx(100.0 / 3.6 / 5.0, rel=1e-9)
    assert last["car"] == pytest.approx(285.0)
    assert (first["verdict"], last["verdict"]) == ("within", "within")


def test_deviations_are_reported_with_their_size() -> None:
    assert FROM_REST.row(0.9 * (4.5 - 0.05))["verdict"] == "-10 %"
    assert FROM_REST.row(4.46)["verdict"] == "within"
    assert TOP_SPEED.row(1.2 * 290.5)["verdict"] == "+20 %"
