"""Systems of cars and controllers in separate FMUs, to test the effect of the communication step."""

from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import numpy as np
from pythonfmu import FmuBuilder

from hosts.common.numbers import Value
from hosts.systems import CoupledFmus
from hosts.systems.coupled_fmus import Inputs, Order
from tests.hosts.systems.trailer import passing_folder
from tests.hosts.systems.weak_coupling import car_fmu
from tests.vehicle.cars_with_ports import WHEELS

CONTROLLERS = Path(__file__).parents[3] / "examples" / "controllers"
FRONT = ("FL", "FR")
REAR = ("RL", "RR")
INNER = 0.001  # s, step of the cars


@dataclass(frozen=True)
class Controlled:
    """A system of cars and controllers."""

    cars: dict[str, str]
    """Ports of the prototype by names of parts; empty: none."""
    controllers: dict[str, str]
    """Names of their files by names of parts."""
    wires: dict[str, str]
    """Connections, argument of `CoupledFmus`."""
    start: dict[str, Value]
    """Start values, of which `switch` turns the controller on."""
    time: float
    """Duration, s."""
    measure: str
    """Output whose final values are compared between communication steps."""
    reads: tuple[str, ...]
    switch: dict[str, float] = field(default_factory=dict)
    sources: dict[str, str] = field(default_factory=dict)
    """Drivers by schedule, stepped before the cars."""


SLIP_WIRES = (
    {"controller.speed": "car.speed"}
    | {f"controller.omega_{w}": f"car.wheel_{w}.omega" for w in WHEELS}
    | {f"car.wheel_{w}.brake_torque_demand": f"controller.torque_{w}" for w in WHEELS}
)
ON = {"controller.on": 1.0}
SYSTEMS = {
    "anti-lock brakes": Controlled(
        {"car": "brakes"},
        {"controller": "slip_controller"},
        SLIP_WIRES,
        {"car.initial.speed": 15.0, "car.road.friction": 0.5, "car.selector": 0},
        *(5.0, "car.chassis.x", ("car.chassis.x", "car.speed"), ON),
    ),
    "brakes on split friction": Controlled(
        {"car": "brakes"},
        {"controller": "slip_controller", "driver": "course_holder"},
        SLIP_WIRES
        | {"driver.y": "car.chassis.y", "driver.yaw": "car.chassis.yaw", "driver.yaw_rate": "car.chassis.wz"}
        | {"car.steering": "driver.steering"},
        {"car.initial.speed": 15.0, "car.road.file": "split.road", "car.selector": 0},
        *(6.0, "car.chassis.x", ("car.chassis.x", "car.chassis.y", "car.chassis.yaw", "car.speed"), ON),
    ),
    "yaw control": Controlled(
        {"car": "brakes"},
        {"controller": "yaw_control"},
        {"controller.speed": "car.speed", "controller.yaw_rate": "car.chassis.wz"}
        | {"controller.steering": "driver.steering", "car.steering": "driver.steering"}
        | {f"car.wheel_{w}.brake_torque_demand": f"controller.torque_{w}" for w in FRONT},
        {"car.initial.speed": 22.0, "car.selector": 0, "driver.amplitude": 0.2}
        | {f"car.wheel_{w}.brake_torque_demand": 0.0 for w in REAR},
        *(4.2, "car.chassis.y", ("car.chassis.y", "car.chassis.yaw", "car.chassis.wz", "car.speed"), ON),
        sources={"driver": "sine_with_dwell"},
    ),
    "torque vectoring": Controlled(
        {"car": "torque=hub_motors"},
        {"controller": "torque_vectoring"},
        {"controller.speed": "car.speed", "controller.yaw_rate": "car.chassis.wz"}
        | {f"car.wheel_{w}.drive_torque": f"controller.torque_{w}" for w in REAR},
        {"car.initial.speed": 12.0, "car.steering": 0.25, "controller.steering": 0.25, "controller.demand": 150.0}
        | {f"car.wheel_{w}.drive_torque": 0.0 for w in FRONT},
        *(3.0, "car.chassis.yaw", ("car.chassis.yaw", "car.chassis.wz", "car.speed"), ON),
    ),
    "two cars": Controlled(
        {"ahead": "", "car": ""},
        {"controller": "distance_controller"},
        {
            "controller.x": "car.chassis.x",
            "controller.speed": "car.speed",
            "controller.x_ahead": "ahead.chassis.x",
            "controller.speed_ahead": "ahead.speed",
            "car.throttle": "controller.throttle",
            "car.brake": "controller.brake",
            "ahead.throttle": "driver.throttle",
            "ahead.brake": "driver.brake",
        },
        {"ahead.initial.x": 30.0, "ahead.initial.speed": 15.0, "car.initial.speed": 15.0},
        *(8.0, "car.chassis.x", ("controller.gap", "car.speed", "ahead.speed", "car.chassis.x")),
        sources={"driver": "brake_pulse"},
    ),
}


@cache
def controller_fmu(name: str) -> Path:
    """The FMU of a controller whose state can be saved, built by PythonFMU once per process."""
    file = CONTROLLERS / f"{name}.py"
    return Path(FmuBuilder.build_FMU(file, dest=passing_folder(), canGetAndSetFMUstate=True))


def parts_of(case: Controlled) -> dict[str, Path]:
    """The FMUs of a system."""
    cars = {name: car_fmu("prototype", ports or None) for name, ports in case.cars.items()}
    sources, controllers = (
        {name: controller_fmu(file) for name, file in each.items()} for each in (case.sources, case.controllers)
    )
    return sources | cars | controllers


def start_of(name: str, on: bool = True) -> dict[str, Value]:
    """Start values of a system, with or without its controller."""
    case = SYSTEMS[name]
    return case.start | (case.switch if on else {}) | {f"{car}.step_size": INNER for car in case.cars}


def run(
    name: str, step: float, *, order: Order = "in turn", inputs: Inputs = "held", on: bool = True
) -> dict[str, np.ndarray]:
    """Columns of a run by name, with or without its controller; fails if there are messages."""
    case = SYSTEMS[name]
    start = start_of(name, on)
    with CoupledFmus(parts_of(case), case.wires, step=step, order=order, inputs=inputs) as system:
        system.initialise(**start)
        reads = tuple(dict.fromkeys((*case.reads, case.measure)))
        rows = system.run(case.time, reads)
        assert not system.messages, system.messages
    return dict(zip(reads, rows.T, strict=True))
