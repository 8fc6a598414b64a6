"""Measured inputs: a speed is held closely without swinging where steps are long; a follower moves as measured."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lsim

from hosts.compare.measured_speed import make_speed_holder
from hosts.compare.plausibility import scale_mistake
from hosts.compare.replay import follower_demand
from hosts.compare.segments import Segment
from hosts.compare.windows import held_speed_text
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.result import Result
from hosts.measures.signal import Signal


@pytest.mark.parametrize("step", [0.01, 0.05, 0.1])
def test_a_measured_speed_is_held_closely_by_pedals_that_do_not_swing(step: float) -> None:
    """By a car of 8 m/s2 of throttle and 12 of brake, whose drag the driver does not know."""
    t = np.arange(0.0, 20.0, 0.01)
    holder = make_speed_holder(Signal("speed", "v", "m/s", t, 20.0 + 2.0 * np.sin(0.8 * t)), 0.2, step)
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


def test_the_follower_moves_as_measured() -> None:
    t = np.arange(0.0, 2.0, 0.001)
    w = 2.0 * np.pi * 10.0
    follower = ([w**2], [1.0, 2.0 * w, w**2])
    # With a time constant of 16 ms, it moves as it can only.
    moved = lsim(follower, np.sin(2.0 * np.pi * np.clip(t - 0.3, 0.0, None)), t)[1]
    samples = Signal("x", "1", "x", t[::10], moved[::10])
    demand = follower_demand(samples, 10.0, t)
    again = lsim(follower, demand, t)[1]
    assert again[: len(t) - 10] == pytest.approx(moved[: len(t) - 10], abs=3e-3)
    assert np.abs(lsim(follower, moved, t)[1] - moved).max() > 0.15  # taken as the demand, it is late
    assert (demand[0], demand[-1]) == pytest.approx((moved[0], moved[-10]), abs=1e-12)
