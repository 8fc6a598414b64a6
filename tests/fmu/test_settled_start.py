"""The parameter `initial.settling`: a start in motion is held until tyres, springs and steering have settled."""

from pathlib import Path

import mbs
from mbs.kernel.binding import LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.scenes import prototype_car
from tests.fmu.calls import HostMaker

H = 0.01
START = {"initial.speed": 20.0, "initial.lateral_speed": 0.3, "initial.yaw_rate": 0.25}
OUTPUTS = ("chassis.roll", "chassis.ay", "wheel_FL.Fz", "wheel_RR.Fy", "energy.kinetic", "chassis.x")


def test_it_is_the_start_of_the_engine(prototype_fmu: Path, host: HostMaker) -> None:
    driven = host(prototype_fmu).start(
        {**START, "steering": 0.1, "brake": 0.1, "step_size": H, "initial.settling": 1.0}
    )
    system = mbs.compile(prototype_car.build())
    instance = Instance(LoadedSystem(system.to_bytes()))
    inputs, sensors = ([entry["name"] for entry in system.meta[k]] for k in ("inputs", "sensors"))
    for name in ("steering", "brake"):
        instance.set_input(inputs.index(name), 0.1)
    instance.set_pose(0.0, 0.0, 0.0, 0.0, *START.values())
    instance.initialise(0.0)
    instance.settle(1.0, H)
    for k in range(10):
        actual = instance.sensors()
        assert [driven.get(n) for n in OUTPUTS] == [actual[sensors.index(n)] for n in OUTPUTS]
        assert driven.step(k * H, H) == 0
        instance.step(H)
    assert abs(actual[sensors.index("chassis.roll")]) > 0.03


def test_one_that_has_not_settled_is_reported(prototype_fmu: Path, host: HostMaker) -> None:
    short, long = (host(prototype_fmu).start({**START, "initial.settling": t}) for t in (0.1, 3.0))
    assert any("has not settled" in m and "initial.settling" in m for m in short.messages)
    assert not any("settle" in m for m in long.messages)
