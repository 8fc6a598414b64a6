"""Errors of cars coupled with parts in second FMUs against one model, by the communication step."""

import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from unittest.mock import patch

import numpy as np
from matplotlib.figure import Figure
from pythonfmu import FmuBuilder

import mbs
from hosts.fmu import built_fmu
from hosts.fmu.built_fmu import fmu_of_car
from hosts.systems import CoupledFmus
from hosts.systems.coupled_fmus import Inputs, Order
from mbs.vehicle import load
from tests.hosts.systems import trailer
from tests.hosts.systems.fmus.second_road import ANSWER
from tests.hosts.systems.fmus.second_tyres import READ
from tests.in_process import build_fmu
from tests.vehicle import test_road_port
from tests.vehicle.cars_with_ports import WHEELS, throttle_at
from tests.vehicle.rigid_car import rigid_car
from tests.vehicle.second_tyres import HUB

FMUS = Path(__file__).parent / "fmus"
INNER = 0.002  # s, step of the car
TIME = 1.0  # s
SPEED = 10.0  # m/s
Wires = dict[str, str]


@dataclass(frozen=True)
class Case:
    """A car, its port and the FMU in place of what the port replaces."""

    car: str
    ports: str
    partner: str
    """`car`, `ports`, `partner`: names."""
    wires: Wires
    """Connections, argument of `CoupledFmus`; the car is ``car``."""
    loads: tuple[str, ...]
    """Wheel loads, as ``part.variable``."""
    inputs: dict[str, float]
    """Constant inputs of the driver; `throttle` of the closed car may follow a schedule."""
    path: tuple[str, str] = ("car.chassis.x", "car.chassis.y")
    """Output compared at the end, as ``part.variable``."""
    throttle: Callable[[float], float] | None = None


CAR_LOADS = tuple(f"car.wheel_{w}.Fz" for w in WHEELS)
NO_TORQUE = {f"point_hitch.M{c}": 0.0 for c in "xyz"}
CASES = {
    "drive": Case(
        *("prototype", "torque", "second_drive"),
        {f"partner.omega_{s}": f"car.wheel_R{s}.omega" for s in "LR"}
        | {f"car.wheel_R{s}.drive_torque": "partner.torque" for s in "LR"},
        *(CAR_LOADS, {"steering": 0.1, "wheel_FL.drive_torque": 0.0, "wheel_FR.drive_torque": 0.0}),
        throttle=throttle_at,
    ),
    "road": Case(
        *("hatchback", "road", "second_road"),
        {f"partner.{w}.{c}": f"car.wheel_{w}.road_ahead_{c}" for w in WHEELS for c in "xy"}
        | {f"car.wheel_{w}.road_{n}": f"partner.{w}.road_{n}" for w in WHEELS for n in ANSWER},
        *(CAR_LOADS, {"steering": 0.05, "throttle": 0.3}),
    ),
    "tyre": Case(
        *("hatchback", "tyre", "second_tyres"),
        {f"partner.wheel_{w}.{n}": f"car.wheel_{w}.{n}" for w in WHEELS for n in READ}
        | {f"car.wheel_{w}.{n}": f"partner.wheel_{w}.{n}" for w in WHEELS for n in HUB},
        *(tuple(f"partner.wheel_{w}.load" for w in WHEELS), {"steering": 0.2}),
    ),
    "trailer": Case(
        *("hatchback", "forces=earth", "ball"),
        {f"partner.car.{b}{c}": f"car.point_hitch.{a}{c}" for a, b in (("", "p"), ("v", "v")) for c in "xyz"}
        | {f"partner.trailer.{a}{c}": f"trailer.hitch.{a}{c}" for a in "pv" for c in "xyz"}
        | {f"car.point_hitch.F{c}": f"partner.car.F{c}" for c in "xyz"}
        | {f"trailer.hitch.F{c}": f"partner.trailer.F{c}" for c in "xyz"},
        *((*CAR_LOADS, "trailer.load_L", "trailer.load_R"), {"steering": 0.2, "throttle": 0.3} | NO_TORQUE),
        path=("trailer.trailer.x", "trailer.trailer.y"),
    ),
}


@cache
def partner_fmu(name: str) -> Path:
    """The FMU of a script, built by PythonFMU once per process."""
    return Path(FmuBuilder.build_FMU(FMUS / f"{name}.py", dest=trailer.passing_folder(), canGetAndSetFMUstate=True))


@cache
def car_fmu(car: str, ports: str | None) -> Path:
    """The car without its flexible frame, with its ports; kept, and built in this process."""

    def build(what: str, options: tuple[str, ...], place: Path) -> None:
        build_fmu(place, *options)

    with tempfile.TemporaryDirectory() as folder, patch.object(built_fmu, "build_fmu", build):
        file = rigid_car(car, Path(folder) / car)
        return fmu_of_car(str(file), lambda text: None, ports=ports)


def parts_of(name: str, inputs: Inputs = "held") -> dict[str, Path]:
    """The FMUs of a case in turn; a road that is followed comes first, so that planes go from answer to answer."""
    case, partner = CASES[name], partner_fmu(CASES[name].partner)
    if name == "trailer":
        return trailer.fmus() | {"partner": partner}
    both = {"car": car_fmu(case.car, case.ports), "partner": partner}
    return dict(reversed(both.items())) if (name, inputs) == ("road", "followed") else both


def start_of(name: str, order: Order = "at once", inputs: Inputs = "held") -> dict[str, float]:
    """Start values of the parts of a case; a road is asked for the end of the step in which its answer holds."""
    case = CASES[name]
    movable = [part for part in ("car", "trailer") if part in parts_of(name)]
    start = {f"{part}.initial.speed": SPEED for part in movable} | {f"car.{n}": x for n, x in case.inputs.items()}
    lead = 0.0 if inputs == "repeated" else 1.0 if order == "in turn" else 2.0
    return start | ({"car.ports.road_lead": lead} if name == "road" else {})


def closed_system(name: str) -> mbs.System:
    """The case as one model."""
    if name == "trailer":
        return trailer.with_trailer()
    return test_road_port.closed() if name == "road" else mbs.compile(load(CASES[name].car).model())


@cache
def closed(name: str) -> tuple[np.ndarray, np.ndarray]:
    """Wheel loads and way of the closed car at every inner step."""
    case = CASES[name]
    system = closed_system(name)
    names = [entry["name"] for entry in system.meta["inputs"]]
    inputs = {n: x for n, x in case.inputs.items() if n in names}
    s = mbs.Simulation(system, pose=mbs.Pose(speed=SPEED), inputs=inputs)
    own = CAR_LOADS if name == "tyre" else case.loads
    read, path = ([n.partition(".")[2] for n in names] for names in (own, case.path))
    loads, ways, row = [], [], np.array([s.instance.get_input(i) for i in range(len(names))])
    for k in range(round(TIME / INNER) + 1):
        now = s.sensors
        loads.append([now[n] for n in read])
        ways.append([now[n] for n in path])
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
    with CoupledFmus(parts_of(name, inputs), case.wires, step=step, order=order, inputs=inputs) as system:
        system.initialise(**start_of(name, order, inputs))
        rows = system.run(TIME, (*case.loads, *case.path))
        messages = system.messages
    loads, ways = (values[:: round(step / INNER)] for values in closed(name))
    load = np.sqrt(np.mean((rows[1:, :-2] - loads[1:]) ** 2)) / loads.mean()
    path = np.linalg.norm(rows[-1, -2:] - ways[-1]) / np.linalg.norm(ways[-1] - ways[0])
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
    figure = Figure(figsize=(11.0, 3.4), layout="constrained")
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


def percent(share: float) -> str:
    """Two digits of a share, without an exponent where it is large."""
    return f"{100.0 * share:.0f} %" if share >= 0.995 else f"{100.0 * share:.2g} %"


def lines(errors: Errors) -> Iterator[str]:
    """The table, whose numbers are left in `errors`."""
    yield (
        "| part | order | inputs | " + " | ".join(f"{1e3 * h:g} ms: loads, path" for h in STEPS) + " | measured order |"
    )
    yield "| --- | --- | --- |" + " --- |" * (len(STEPS) + 1)
    for name in CASES:
        for order, inputs in WAYS:
            results = [coupled(name, h, order, inputs) for h in STEPS]
            errors[name, order, inputs] = [(load, path) for load, path, _ in results]
            rate = np.log(results[1][0] / results[0][0]) / np.log(2.0)
            cells = " | ".join(f"{percent(a)}, {percent(b)}" for a, b, _ in results)
            yield f"| {name} | {order} | {inputs} | {cells} | {rate:.1f} |"
