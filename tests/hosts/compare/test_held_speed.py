"""A measured speed is held within 0.05 m/s, and without swinging where communication steps are long."""

import numpy as np
import pytest

from hosts.compare.segment_fmu import _make_speed_holder
from hosts.measures.signal import Signal


@pytest.mark.parametrize("step", [0.01, 0.05, 0.1])
def test_a_measured_speed_is_held_closely_by_pedals_that_do_not_swing(step: float) -> None:
    """By a car of 8 m/s2 of throttle and 12 of brake, whose drag the driver does not know."""
    t = np.arange(0.0, 20.0, 0.01)
    holder = _make_speed_holder(Signal("speed", "v", "m/s", t, 20.0 + 2.0 * np.sin(0.8 * t)), 0.2, step)
    speed, errors, pedals = 20.0, [], []
    for k in range(round(19.0 / step)):
        act = holder.act(k * step, {"speed": speed})
        errors.append(speed - holder.target_speed(k * step))
        pedals.append(act["throttle"] - act["brake"])
        speed += step * (8.0 * act["throttle"] - 12.0 * act["brake"] - 1e-3 * speed**2)
    late = round(2.0 / step)
    rms = float(np.sqrt(np.mean(np.square(errors[late:]))))
    assert rms < (0.008 if step <= 0.01 else 0.25)
    turns = np.diff(np.sign(np.diff(pedals[late:])))
    assert np.count_nonzero(turns) < 40, "a few in each period of 8 s"
