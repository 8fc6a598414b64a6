"""A measured speed that falls while the simulated one rises."""

from dataclasses import replace

import numpy as np
import pytest

from hosts.compare.plausibility import scale_mistake
from hosts.compare.segments import Segment
from hosts.compare.windows import held_speed_text
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.result import Result
from hosts.measures.signal import Signal


@pytest.mark.parametrize("turned", [False, True])
def test_a_speed_that_falls_where_the_simulated_rises_has_no_other_sign(turned: bool) -> None:
    t = np.arange(0.0, 6.0, 0.01)
    measured = Signal("speed", "v", "m/s", t, -15.0 - t if turned else 15.0 - t)
    assert ("factor = -1.0" in scale_mistake(measured, lambda when: 15.0 + when)) == turned


def test_time_with_a_pedal_at_its_end_is_reported_separately() -> None:
    """0.3 m/s off for the quarter of the time with full throttle, 0.1 m/s elsewhere."""
    t = np.linspace(0.0, 4.0, 401)
    full = t >= 3.0
    values = np.column_stack((20.0 - np.where(full, 0.3, 0.1), np.where(full, 1.0, 0.4), 0.0 * t))
    result = Result(["speed", "throttle", "brake"], {}, t, values, 1.0, 4.0, 0, [])
    speed = Signal("speed", "v", "m/s", t, 20.0 + 0.0 * t)
    segment = Segment(Manoeuvre("log", t, {}, 4.0, {}), speed)
    (message,) = held_speed_text(result, [segment])
    assert (
        "within 0.17 m/s rms (-0.2 on the mean), a pedal at its end for 25 % of the time and 0.1 m/s rms else"
        in message
    )
    (message,) = held_speed_text(replace(result, values=values * (1.0, 0.5, 1.0)), [segment])
    assert message == "The driver held the speed within 0.17 m/s rms (-0.2 on the mean)."


def test_how_long_the_driver_eased_the_throttle_is_reported() -> None:
    """Both wheels of the rear axle slide in a tenth of the time, one of them in a fifth."""
    t = np.linspace(0.0, 4.0, 401)
    slips = [np.where(t < part * 4.0, 0.12, 0.02) for part in (0.1, 0.2)]
    values = np.column_stack((20.0 + 0.0 * t, 0.5 + 0.0 * t, 0.0 * t, *slips))
    result = Result(["speed", "throttle", "brake", "wheel_RL.slip", "wheel_RR.slip"], {}, t, values, 1.0, 4.0, 0, [])
    segment = Segment(Manoeuvre("log", t, {}, 4.0, {}), Signal("speed", "v", "m/s", t, 20.0 + 0.0 * t))
    (message,) = held_speed_text(result, [segment])
    assert message.endswith(", eased the throttle over a sliding axle for 10 % of the time.")
