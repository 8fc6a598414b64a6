"""The prototype car rolls over, is set upright where it lies, and is rewound."""

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from hosts.simulator.car import Car, CarSettings
from hosts.simulator.driven_fmu import DrivenFmu

H = 0.002
# With tyres that hold half as well again, full lock at 35 m/s turns it over.
ROLLS_OVER = {"initial.speed": 35.0, "front.tyre.grip": 1.5, "rear.tyre.grip": 1.5, "initial.yaw": 0.5}


def drive(car: DrivenFmu, count: int) -> np.ndarray:
    """Values after each step."""
    rows = []
    for _ in range(count):
        car.advance()
        rows.append(car.values.copy())
    return np.array(rows)


@pytest.mark.slow
def test_upright_after_a_roll_over(fmu: Callable[[str], Path]) -> None:
    car = DrivenFmu(fmu("prototype_car"), ROLLS_OVER, H)
    x, y, z, yaw, roll, speed = (
        car.names.index(n) for n in ("chassis.x", "chassis.y", "chassis.z", "chassis.yaw", "chassis.roll", "speed")
    )
    standing = car.values[z]
    wants = np.zeros((len(car.inputs.values), 3))
    wants[car.names.index("steering")] = 1.0, math.inf, 1.0
    car.inputs.want(wants.ravel())
    rows = drive(car, 3000)
    assert np.abs(rows[:, roll]).max() > 3.0  # on its roof
    observation = car.upright(request=1.0)
    start = car.values.copy()
    assert start[[x, y]] == pytest.approx(rows[-1, [x, y]], abs=1e-6)
    assert math.remainder(start[yaw] - rows[-1, yaw], 2.0 * math.pi) == pytest.approx(0.0, abs=1e-6)
    assert start[[roll, speed]] == pytest.approx([0.0, 0.0], abs=1e-6)
    assert start[z] == pytest.approx(standing, abs=1e-6)
    assert observation.details["start"]["front.tyre.grip"] == 1.5  # the parameters are those of the start
    assert car.time == pytest.approx(6.0)
    after = drive(car, 500)
    assert np.abs(after[:, roll]).max() < 0.01
    # Back to before the roll-over, over the new start, and on as it was then.
    car.rewind(501 * H + 4.0)
    assert car.time == pytest.approx(2.0)
    assert np.array_equal(car.values, rows[999])
    wants[car.names.index("steering"), 2] = 2.0
    car.inputs.want(wants.ravel())
    assert np.array_equal(drive(car, 2000), rows[1000:])
    car.close()
    car.close()


def test_full_lock_is_where_the_ratio_that_is_set_has_it(fmu: Callable[[str], Path]) -> None:
    """The constant by which a wheel of a device steers, against the angle of the car's steering wheel at full lock."""
    start = {"steering.rack_per_turn": 0.03}
    with Car(CarSettings(fmu("prototype_car"), start, paced=False, priority=False)) as driven_car:
        angle_max = driven_car.constants["vehicle.steering_wheel_angle_max"]
    car = DrivenFmu(fmu("prototype_car"), start, H)
    wants = np.zeros((len(car.inputs.values), 3))
    wants[car.names.index("steering")] = 1.0, math.inf, 1.0
    car.inputs.want(wants.ravel())
    angle = drive(car, 500)[-1, car.names.index("steering_wheel_angle")]
    car.close()
    assert angle == pytest.approx(angle_max, rel=1e-3)


@pytest.mark.slow
def test_memory_does_not_grow(fmu: Callable[[str], Path]) -> None:
    psutil = pytest.importorskip("psutil")
    car = DrivenFmu(fmu("prototype_car"), {"initial.speed": 10.0}, H)
    for _ in range(16_000):  # until the saved states are as many as they get
        car.advance()
    before = psutil.Process().memory_info().rss
    for k in range(20_000):
        car.advance()
        if k % 1000 == 999:
            car.rewind(1.0)
        if k % 5000 == 4999:
            car.reset(request=0.0)
    assert psutil.Process().memory_info().rss - before < 1e6
    car.close()
