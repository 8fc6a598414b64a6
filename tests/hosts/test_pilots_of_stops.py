"""Pilots that brake, fix the steering and follow lines, with simple models of cars."""

import math
from collections.abc import Mapping

import numpy as np
import pytest

from hosts.driving.course import course_of
from hosts.driving.pilots.braking_pilot import Braking
from hosts.driving.pilots.line_follower import LineFollower
from hosts.driving.pilots.run_up_pilot import RunUpPilot
from hosts.driving.pilots.steering_table import FixedSteering
from hosts.driving.planned_course import planned


class Wave:
    """Steers a sine, with half of the throttle."""

    def act(self, time: float, observation: Mapping[str, float]) -> dict[str, float]:
        return {"steering": 0.3 + 0.1 * math.sin(2 * math.pi * time), "throttle": 0.5, "brake": 0.0}


@pytest.mark.parametrize("step", [0.001, 0.005, 0.02])
def test_the_pedal_rises_alike_for_any_step(step: float) -> None:
    pilot = Braking(Wave(), lambda time, observation: time >= 1.0 - 1e-9, 0.8, 0.1, {"selector": (1.0, 0.0)})
    acts = [pilot.act(k * step, {}) for k in range(round(1.5 / step))]
    time = step * np.arange(len(acts))
    brake = np.array([a["brake"] for a in acts])
    assert pilot.onset == pytest.approx(1.0)
    assert (brake[time < 1.0 - 1e-9] == 0.0).all()
    # held through its step, the pedal has the impulse of the ramp: 0.8 (0.5 - 0.1 / 2)
    assert brake.sum() * step == pytest.approx(0.8 * 0.45, rel=1e-9)
    after = [a for a, t in zip(acts, time, strict=True) if t >= 1.0 - 1e-9]
    assert {a["throttle"] for a in after} == {0.0}
    assert {a["selector"] for a in after} == {0.0}
    assert len({a["steering"] for a in after}) == 1
    assert acts[0]["selector"] == 1.0


def test_steering_is_fixed_at_its_mean() -> None:
    pilot = FixedSteering(Wave(), 2.0, 1.0)
    acts = [pilot.act(k * 0.001, {}) for k in range(3000)]
    # the mean over a whole period of the sine
    assert acts[-1]["steering"] == pytest.approx(0.3, abs=1e-9)
    assert acts[2000]["steering"] == acts[-1]["steering"]
    assert acts[1250]["steering"] == pytest.approx(0.4, abs=1e-6)
    assert acts[-1]["throttle"] == 0.5


@pytest.mark.parametrize(("x0", "y0", "yaw0"), [(0.0, 0.0, 0.0), (100.0, -40.0, 2.5)])
def test_a_car_without_slip_follows_the_line_from_wherever_it_is(x0: float, y0: float, yaw0: float) -> None:
    # axles 1.3 m before and behind the centre; the car answers the steering at once
    step, speed, half = 0.005, 15.0, 1.3
    course = planned(course_of("iso_3888_2", 1.8, 12.0), 0.0, 4.2, 1.8)
    pilot = RunUpPilot(LineFollower(course, 2 * half, 0.6, 0.0, 0.4, 0.0), speed, lambda t, s: t >= 0.5, 20.0)
    x, y, yaw, sideslip, rate = x0, y0, yaw0, 0.0, 0.0
    seen, pedals = [], []
    for k in range(1100):
        observation = {"chassis.x": x, "chassis.y": y, "chassis.yaw": yaw, "speed": speed}
        act = pilot.act(k * step, observation | {"sideslip": sideslip, "chassis.wz": rate})
        sideslip = math.atan(0.5 * math.tan(act["steering"] * 0.6))
        rate = speed * math.sin(sideslip) / half
        x += step * speed * math.cos(yaw + sideslip)
        y += step * speed * math.sin(yaw + sideslip)
        yaw += step * rate
        if not math.isnan(pilot.start):
            seen.append(pilot.pose_on_course({"chassis.x": x, "chassis.y": y, "chassis.yaw": yaw}))
            pedals.append(act["throttle"])
    path = np.array(seen)
    assert path[-1, 0] > course.gates[-1].x_end
    astray = np.array([p[1] - course.path(p[0])[0] for p in path])
    # its centre moves aside with the steering, before it turns
    assert np.abs(astray).max() < 0.15
    assert abs(astray[-1]) < 0.01
    # the pedals are released where they have to be, and stay so
    released = path[:, 0] > 20.0 + speed * step
    assert not np.array(pedals)[released].any()
