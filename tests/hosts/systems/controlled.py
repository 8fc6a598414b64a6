"""Cars with controllers in second FMUs, and what the communication step changes.

python -m tests.hosts.systems.controlled
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import numpy as np
from pythonfmu import FmuBuilder

from hosts.common.numbers import Value
from hosts.systems import CoupledFmus
from hosts.systems.coupled import Inputs, Order
from tests.hosts.systems.weak_coupling import car_fmu
from tests.vehicle.test_ports import WHEELS

CONTROLLERS = Path(__file__).parents[3] / "examples" / "controllers"
REAR, INNER = ("RL", "RR"), 0.001  # s


@dataclass(frozen=True)
class Controlled:
    """A system with one controller.

    Parameters
    ----------
    cars : dict of str to str
        Ports of the prototype by names of parts; empty: none.
    controller : str
        Name of its file.
    wires : dict of str to str
        As `CoupledFmus` takes them.
    start : dict
        Start values, of which `switch` turns the controller on.
    time : float
        s.
    measure : str
        What is compared between communication steps at the end.
    """

    cars: dict[str, str]
    controller: str
    wires: dict[str, str]
    start: dict[str, Value]
    time: float
    measure: str
    reads: tuple[str, ...]
    act: Callable[[CoupledFmus], None] | None = None
    switch: dict[str, float] = field(default_factory=dict)


def braked(system: CoupledFmus) -> None:
    """The car ahead brakes for two seconds."""
    system.fmu("ahead").setter(["brake", "throttle"])([0.25 if 1.0 <= system.time < 3.0 else 0.0, 0.05])


SYSTEMS = {
    "anti-lock brakes": Controlled(
        {"car": "brakes"},
        "slip_controller",
        {"controller.speed": "car.speed"}
        | {f"controller.omega_{w}": f"car.wheel_{w}.omega" for w in WHEELS}
        | {f"car.wheel_{w}.brake_torque_demand": f"controller.torque_{w}" for w in WHEELS},
        {"car.initial.speed": 15.0, "car.road.friction": 0.5, "car.selector": 0},
        *(5.0, "car.chassis.x", ("car.chassis.x", "car.speed")),
        switch={"controller.on": 1.0},
    ),
    "torque vectoring": Controlled(
        {"car": "torque=hub_motors"},
        "torque_vectoring",
        {"controller.speed": "car.speed", "controller.yaw_rate": "car.chassis.wz"}
        | {f"car.wheel_{w}.drive_torque": f"controller.torque_{w}" for w in REAR},
        {"car.initial.speed": 12.0, "car.steering": 0.25, "controller.steering": 0.25, "controller.demand": 150.0}
        | {f"car.wheel_F{s}.drive_torque": 0.0 for s in "LR"},
        *(3.0, "car.chassis.yaw", ("car.chassis.yaw", "car.chassis.wz", "car.speed")),
        switch={"controller.on": 1.0},
    ),
    "two cars": Controlled(
        {"ahead": "", "car": ""},
        "distance_controller",
        {
            "controller.x": "car.chassis.x",
            "controller.speed": "car.speed",
            "controller.x_ahead": "ahead.chassis.x",
            "controller.speed_ahead": "ahead.speed",
            "car.throttle": "controller.throttle",
            "car.brake": "controller.brake",
        },
        {"ahead.initial.x": 30.0, "ahead.initial.speed": 15.0, "car.initial.speed": 15.0},
        *(8.0, "car.chassis.x", ("controller.gap", "car.speed", "ahead.speed", "car.chassis.x")),
        braked,
    ),
}


@cache
def controller_fmu(name: str) -> Path:
    """A controller, built by PythonFMU once a process."""
    return Path(FmuBuilder.build_FMU(CONTROLLERS / f"{name}.py", dest=tempfile.mkdtemp()))


def parts_of(case: Controlled) -> dict[str, Path]:
    """The FMUs of a system."""
    cars = {name: car_fmu("prototype", ports or None) for name, ports in case.cars.items()}
    return cars | {"controller": controller_fmu(case.controller)}


def run(
    name: str, step: float, *, order: Order = "in turn", inputs: Inputs = "held", on: bool = True
) -> dict[str, np.ndarray]:
    """Columns of a run by name, with or without its controller; and what was said, which must be nothing."""
    case = SYSTEMS[name]
    start = case.start | (case.switch if on else {}) | {f"{car}.step_size": INNER for car in case.cars}
    with CoupledFmus(parts_of(case), case.wires, step=step, order=order, inputs=inputs) as system:
        system.initialise(**start)
        reads = tuple(dict.fromkeys((*case.reads, case.measure)))
        rows = system.run(case.time, reads, case.act)
        assert not system.messages, system.messages
    return dict(zip(reads, rows.T, strict=True))


def main() -> None:
    """Print by how much the measure at the end changes with the step, in parts of its change over the run."""
    steps = (0.002, 0.004, 0.01)
    print("| system | measured at the end | " + " | ".join(f"{1e3 * h:g} ms" for h in steps) + " | measured order |")
    print("| --- | --- |" + " --- |" * (len(steps) + 1))
    for name, case in SYSTEMS.items():
        finest = run(name, 0.001, inputs="followed")[case.measure]
        for inputs in ("held", "followed"):
            errors = [abs(run(name, h, inputs=inputs)[case.measure][-1] - finest[-1]) / np.ptp(finest) for h in steps]
            rate = np.log(errors[2] / errors[1]) / np.log(2.5)
            cells = " | ".join(f"{100 * e:.2g} %" for e in errors)
            print(f"| {name}, {inputs} | `{case.measure}` | {cells} | {rate:.1f} |", flush=True)


if __name__ == "__main__":
    main()
