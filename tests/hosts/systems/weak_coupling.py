"""How far cars wired to copies of their own parts in second FMUs are from the closed car, over the communication step.

python -m tests.hosts.systems.weak_coupling [PICTURE]
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from pythonfmu import FmuBuilder

import mbs
from hosts.fmu.built_fmu import fmu_of_car
from hosts.systems import CoupledFmus
from hosts.systems.coupled import Inputs, Order
from mbs.vehicle import load
from tests.hosts.systems.fmus.second_road import ANSWER
from tests.hosts.systems.fmus.second_tyres import READ
from tests.vehicle import test_road_port
from tests.vehicle.second_tyres import HUB
from tests.vehicle.test_ports import WHEELS, throttle_at

FMUS, INNER, TIME, SPEED = Path(__file__).parent / "fmus", 0.002, 1.0, 10.0
Wires = dict[str, str]


@dataclass(frozen=True)
class Case:
    """A car, its port and the FMU in place of what the port replaces.

    Parameters
    ----------
    car, ports, partner : str
        Names.
    wires : dict
        As `CoupledFmus` takes them; the car is ``car``.
    loads : tuple of str
        Wheel loads, as ``part.variable``.
    inputs : dict
        Of the driver, held over the run; `throttle` of the closed car may follow a schedule.
    """

    car: str
    ports: str
    partner: str
    wires: Wires
    loads: tuple[str, ...]
    inputs: dict[str, float]
    throttle: Callable[[float], float] | None = None


CAR_LOADS = tuple(f"car.wheel_{w}.Fz" for w in WHEELS)
CASES = {
    "drive": Case(
        *("prototype", "torque", "second_drive"),
        {f"partner.omega_{s}": f"car.wheel_R{s}.omega" for s in "LR"}
        | {f"car.wheel_R{s}.drive_torque": "partner.torque" for s in "LR"},
        *(CAR_LOADS, {"steering": 0.1, "wheel_FL.drive_torque": 0.0, "wheel_FR.drive_torque": 0.0}, throttle_at),
    ),
    "road": Case(
        *("hatchback", "road", "second_road"),
        {f"partner.{w}.{c}": f"car.wheel_{w}.contact_{c}" for w in WHEELS for c in "xy"}
        | {f"car.wheel_{w}.road_{n}": f"partner.{w}.road_{n}" for w in WHEELS for n in ANSWER},
        *(CAR_LOADS, {"steering": 0.05, "throttle": 0.3}),
    ),
    "tyre": Case(
        *("hatchback", "tyre", "second_tyres"),
        {f"partner.wheel_{w}.{n}": f"car.wheel_{w}.{n}" for w in WHEELS for n in READ}
        | {f"car.wheel_{w}.{n}": f"partner.wheel_{w}.{n}" for w in WHEELS for n in HUB},
        *(tuple(f"partner.wheel_{w}.load" for w in WHEELS), {"steering": 0.2}),
    ),
}


@cache
def partner_fmu(name: str) -> Path:
    """The FMU of a script, built by PythonFMU once a process."""
    return Path(FmuBuilder.build_FMU(FMUS / f"{name}.py", dest=tempfile.mkdtemp(), canGetAndSetFMUstate=True))


@cache
def car_fmu(car: str, ports: str) -> Path:
    """The car with its ports; kept."""
    return fmu_of_car(car, lambda text: None, ports=ports)


@cache
def closed(name: str) -> tuple[np.ndarray, np.ndarray]:
    """Wheel loads and way of the closed car at every inner step."""
    case = CASES[name]
    system = test_road_port.closed() if name == "road" else mbs.compile(load(case.car).model())
    names = [entry["name"] for entry in system.meta["inputs"]]
    given = {n: x for n, x in case.inputs.items() if n in names}
    s = mbs.Simulation(system, pose=mbs.Pose(speed=SPEED), inputs=given)
    loads, ways, row = [], [], np.array([s.instance.get_input(i) for i in range(len(names))])
    for k in range(round(TIME / INNER) + 1):
        now = s.sensors
        loads.append([now[f"wheel_{w}.Fz"] for w in WHEELS])
        ways.append([now["chassis.x"], now["chassis.y"]])
        if case.throttle is not None:
            if k == 0:
                s.set_input("throttle", case.throttle(0.0))
            row[names.index("throttle")] = case.throttle(INNER * (k + 1))
        s.instance.run(INNER, 1, row)
    return np.array(loads), np.array(ways)


def coupled(
    name: str, step: float, order: Order = "in turn", inputs: Inputs = "held"
) -> tuple[float, float, list[str]]:
    """Error of the wheel loads, rms over their mean, and of the path over its length; what was said."""
    case = CASES[name]
    parts = {"car": car_fmu(case.car, case.ports), "partner": partner_fmu(case.partner)}
    with CoupledFmus(parts, case.wires, step=step, order=order, inputs=inputs) as system:
        start = {"car.initial.speed": SPEED} | {f"car.{n}": x for n, x in case.inputs.items()}
        system.initialise(**start)
        rows = system.run(TIME, (*case.loads, "car.chassis.x", "car.chassis.y"))
        messages = system.messages
    loads, ways = (values[:: round(step / INNER)] for values in closed(name))
    load = np.sqrt(np.mean((rows[1:, :4] - loads[1:]) ** 2)) / loads.mean()
    path = np.linalg.norm(rows[-1, 4:] - ways[-1]) / np.linalg.norm(ways[-1] - ways[0])
    return float(load), float(path), messages


STEPS = (0.002, 0.004, 0.01)
WAYS: tuple[tuple[Order, Inputs], ...] = (
    ("at once", "held"),
    ("in turn", "held"),
    ("in turn", "followed"),
    ("in turn", "repeated"),
)
Errors = dict[tuple[str, str, str], list[tuple[float, float]]]


def chart(errors: Errors, file: Path) -> None:
    """Errors of the wheel loads over the communication step, a panel a part."""
    figure = Figure(figsize=(9.0, 3.4), layout="constrained")
    for panel, name in zip(figure.subplots(1, len(CASES), sharey=True), CASES, strict=True):
        for order, inputs in WAYS:
            loads = [100.0 * load for load, _ in errors[name, order, inputs]]
            panel.loglog([1e3 * h for h in STEPS], loads, marker="o", label=f"{order}, {inputs}")
        panel.set(title=name, xlabel="communication step, ms", xticks=[2, 4, 10], xticklabels=["2", "4", "10"])
        panel.minorticks_off()
        panel.grid(alpha=0.3)
    figure.axes[0].set_ylabel("error of the wheel loads, rms, %")
    figure.axes[0].legend(fontsize="small")
    figure.savefig(file, dpi=90)


def main(picture: str = "") -> None:
    """Print the table, and draw it."""
    print(
        "| part | order | inputs | " + " | ".join(f"{1e3 * h:g} ms: loads, path" for h in STEPS) + " | measured order |"
    )
    print("| --- | --- | --- |" + " --- |" * (len(STEPS) + 1))
    errors: Errors = {}
    for name in CASES:
        for order, inputs in WAYS:
            found = [coupled(name, h, order, inputs) for h in STEPS]
            errors[name, order, inputs] = [(load, path) for load, path, _ in found]
            rate = np.log(found[1][0] / found[0][0]) / np.log(2.0)
            cells = " | ".join(f"{100 * a:.2g} %, {100 * b:.2g} %" for a, b, _ in found)
            print(f"| {name} | {order} | {inputs} | {cells} | {rate:.1f} |", flush=True)
    if picture:
        chart(errors, Path(picture))


if __name__ == "__main__":
    main(*sys.argv[1:])
