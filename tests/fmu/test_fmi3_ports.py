"""What other programs give at ports reaches an FMU of FMI 3.0 as it reaches one of FMI 2.0: the same bits."""

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from numpy.typing import NDArray

from fmu_src.build.build import build_fmu
from fmu_src.build.car_registry import build_car
from hosts.fmu.fmu import Fmu
from mbs.elements.road import ANSWER
from tests import kinds
from tests.vehicle.rigid_car import rigid_car

STEP = 0.01  # s
SPEED = 15.0  # m/s
WHEELS = ("FL", "FR", "RL", "RR")
Given = dict[str, float]


def answer(x: float, y: float, height: float, length: float, friction: float) -> tuple[float, ...]:
    """A road of waves at a place."""
    q = 2.0 * math.pi / length
    slope = height * q * math.cos(q * x)
    normal = np.array([-slope, 0.0, 1.0]) / math.hypot(1.0, slope)
    return (x, y, height * math.sin(q * x), *map(float, normal), friction)


def at_sledge(time: float, now: Mapping[str, float]) -> Given:
    road = answer(now.get("x", 0.0), now.get("y", 0.0), 0.005, 2.0, 0.0)
    return dict(zip((f"road_{name}" for name in ANSWER), road, strict=True)) | {"push": 50.0 * math.sin(3.0 * time)}


def at_car(time: float, now: Mapping[str, float]) -> Given:
    """Everything that ports can replace but the tyres."""
    point = {"Fx": -50.0, "Fy": 500.0 * math.sin(3.0 * time), "Fz": 200.0, "Mx": 20.0, "My": -10.0, "Mz": 100.0 * time}
    inputs = {f"point_reference.{name}": value for name, value in point.items()}
    inputs |= {"wind.speed": 10.0, "wind.heading": 1.0 + time, "hand_brake": 0.0}
    inputs["steering_rack_demand"] = 0.01 * math.sin(2.0 * time)
    for w in WHEELS:
        road = answer(now.get(f"wheel_{w}.contact_x", 0.0), now.get(f"wheel_{w}.contact_y", 0.0), 0.01, 3.0, 0.9)
        inputs |= dict(zip((f"wheel_{w}.road_{name}" for name in ANSWER), road, strict=True))
        inputs[f"wheel_{w}.brake_torque_demand"] = 150.0 if time > 0.3 else 0.0
        inputs[f"wheel_{w}.drive_torque"] = 50.0 if w[0] == "F" else 0.0
    return inputs


def at_hubs(time: float, now: Mapping[str, float]) -> Given:
    """A spring in place of each tyre."""
    inputs = {"steering": 0.1 * math.sin(time), "throttle": 0.1}
    for k, w in enumerate(WHEELS):
        height, rate = now.get(f"wheel_{w}.earth_z", 0.3), now.get(f"wheel_{w}.earth_vz", 0.0)
        load = max(0.0, 3800.0 + 2e5 * (0.3 - height) - 3e3 * rate)
        hub = {"Fx": 20.0 * k, "Fy": 400.0 * math.sin(2.0 * time), "Fz": load, "Mx": 3.0, "My": 1.0, "Mz": 2.0 * k}
        inputs |= {f"wheel_{w}.hub_{name}": value for name, value in hub.items()}
    return inputs


def wild(given: Callable[[float, Mapping[str, float]], Given]) -> Callable[[float, Mapping[str, float]], Given]:
    """What is given, but after the start one of thirty values at ports is not a number, or far beyond, by the time; a
    jump of the road or of a hub's forces is left to tests of refused steps.
    """

    def at(time: float, now: Mapping[str, float]) -> Given:
        random, values = np.random.default_rng(round(1e3 * time)), given(time, now)
        for name in values:
            if time > 0.0 and "." in name and random.random() < 1.0 / 30.0:
                far = [] if "road" in name or "hub" in name else [1e6, -1e6]
                values[name] = float(random.choice([math.nan, math.inf, -math.inf, *far]))
        return values

    return at


def derivatives(fmu: Fmu, outputs: list[str], given: Given) -> NDArray[np.float64]:
    """Of the outputs by what is given, each times one, over the last step; no numbers where that is refused."""
    slave: Any = fmu._slave
    scalars = fmu.scalars(outputs)
    sizes = {scalar.reference: scalar.size for scalar in scalars}
    count = (sum(sizes.values()),) if fmu.description.fmiVersion.startswith("3") else ()
    known = [scalar.reference for scalar in fmu.scalars(given)]
    try:
        result = slave.getDirectionalDerivative(list(sizes), known, [1.0] * len(known), *count)
    except FMICallException:
        return np.full(len(outputs), math.nan)
    begin = dict(zip(sizes, np.cumsum([0, *sizes.values()]), strict=False))
    return np.array([result[begin[scalar.reference] + scalar.index] for scalar in scalars])


def drive(
    file: Path, start: Given, given: Callable[[float, Mapping[str, float]], Given], steps: int
) -> tuple[list[str], NDArray[np.float64], NDArray[np.float64], list[str]]:
    """Names of outputs, their rows, derivatives every ten steps, and messages."""
    with Fmu(file) as fmu:
        outputs = [n for n, v in fmu.variables.items() if v.causality == "output" and v.type == "Real"]
        fmu.initialise(start | given(0.0, {}))
        read, write = fmu.getter(outputs), fmu.setter(list(given(0.0, {})))
        rows, slopes = [read()], []
        for k in range(steps):
            values = given(k * STEP, dict(zip(outputs, rows[-1], strict=True)))
            write(list(values.values()))
            fmu.step(k * STEP, STEP)
            rows.append(read())
            if k % 10 == 9:
                slopes.append(derivatives(fmu, outputs, values))
        return outputs, np.array(rows), np.array(slopes), fmu.messages


def same(
    files: tuple[Path, Path], start: Given, given: Callable[[float, Mapping[str, float]], Given], steps: int
) -> tuple[list[str], NDArray[np.float64]]:
    """Outputs and rows of both, which must be equal to the last bit."""
    (names, rows, slopes, messages), three = (drive(file, start, given, steps) for file in files)
    order = [three[0].index(n) for n in names]
    assert len(order) == len(three[0])
    assert rows.tobytes() == three[1][:, order].tobytes()
    if steps >= 10:
        assert slopes.tobytes() == three[2][:, order].tobytes()
        finite = slopes[np.isfinite(slopes).all(axis=1)]
        assert 2 * len(finite) >= len(slopes)
        assert np.count_nonzero(finite[0]) > 0.5 * len(names)
    assert messages == three[3]
    return names, rows


def test_a_sledge_on_a_road_at_ports(build: Callable[..., Path]) -> None:
    files = (build("answered", "native"), build("answered", "fmi3"))
    names, rows = same(files, {"initial.speed": 2.0}, at_sledge, 60)
    assert np.ptp(rows[:, names.index("z")]) > 2e-3


@pytest.mark.slow
@pytest.mark.parametrize(
    ("ports", "given", "moved"),
    [
        ("torque,brakes,steering,road,forces,wind", at_car, "wheel_FL.Fz"),
        pytest.param("tyre", at_hubs, "chassis.y", marks=pytest.mark.proof),
    ],
    ids=["all but tyres", "tyres"],
)
def test_a_car(tmp_path: Path, ports: str, given: Callable[[float, Mapping[str, float]], Given], moved: str) -> None:
    car = build_car(str(rigid_car("hatchback", tmp_path / "car")), ports=ports)
    system = car.systems[min(car.systems)]
    two, three = (build_fmu(system, car.name, tmp_path, [fmpy.platform], kind=kind) for kind in kinds.VERSIONS)
    names, rows = same((two, three), {"initial.speed": SPEED}, given, 70)
    assert np.ptp(rows[:, names.index(moved)]) > 0.05
    assert np.isfinite(same((two, three), {"initial.speed": SPEED}, wild(given), 9)[1]).all()
