"""FMPy drives FMUs of the prototype car over its reference trajectories, and over motions known without them."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TypeAlias

import fmpy
import numpy as np
import pytest
from numpy.typing import NDArray

from benchmarks.car import accuracy, manoeuvres, statics, trajectories
from fmu_src.build.build import build_fmu
from hosts.driving.manoeuvre import Manoeuvre
from hosts.fmu.fmu import Fmu

Columns: TypeAlias = Mapping[str, NDArray[np.float64]]

H = 0.01  # s, communication and inner step
NAMES = tuple(n for n in manoeuvres.NAMES if n not in manoeuvres.OTHER_ROAD)
SIGNALS = {
    "place": trajectories.POSITION,
    "yaw": ("chassis.yaw",),
    "roll and pitch": ("chassis.roll", "chassis.pitch"),
    "yaw rate": ("chassis.wz",),
    "lateral acceleration": ("chassis.ay",),
    "speed": ("speed",),
    "wheel load": trajectories.LOADS,
    "travel": tuple(f"wheel_{w}.travel" for w in trajectories.WHEELS),
}
# Largest errors with inner steps of 10 ms, about three times what was measured: of the place as a share of the path, of
# the others as a share of their largest change.
BOUNDS = {
    "launch_and_brake": (1.6e-4, 0.015),
    "kerb_drop": (2.5e-4, 0.1),
    "step_steer": (2e-6, 0.006),
    "slalom": (1e-5, 0.0015),
    "drop": (3e-3, 0.14),
    "steady_cornering": (2e-6, 1.5e-4),
    "double_lane_change_replay": (3e-6, 0.001),
    "full_lock": (2e-4, 0.015),
    "kerb_lock_brake": (8e-4, 0.33),
}
# The same for held inputs against the kernel with inputs that are late by half a communication step, of the manoeuvres
# whose inputs change.
LEFT = {
    "launch_and_brake": (3e-4, 0.013),
    "step_steer": (2.2e-5, 0.006),
    "slalom": (8e-6, 0.0015),
    "steady_cornering": (7e-6, 1.5e-4),
    "double_lane_change_replay": (4e-6, 0.001),
    "full_lock": (7e-4, 0.015),
    "kerb_lock_brake": (7e-4, 0.5),
}


def errors(found: Columns, reference: Columns, length: float) -> dict[str, float]:
    """Largest error of each group of signals: of the place over the path, else over the largest change."""
    result = {}
    for group, names in SIGNALS.items():
        gap = np.array([found[n] - reference[n] for n in names])
        if group == "yaw":
            gap = (gap + np.pi) % (2.0 * np.pi) - np.pi
        if group == "place":
            result[group] = float(np.linalg.norm(gap, axis=0).max()) / length
            continue
        size = max(float(np.ptp(reference[n])) for n in names)
        result[group] = float(np.abs(gap).max()) / size if size > 1e-6 else 0.0
    return result


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """The prototype car as an FMU of a kind, built once."""

    def build(kind: str) -> Path:
        system, folder = manoeuvres.system_of("drop"), tmp_path_factory.mktemp(kind)
        return build_fmu(system, "prototype_car", folder, [fmpy.platform], kind=kind)

    return functools.cache(build)


@pytest.fixture
def car(request: pytest.FixtureRequest, built: Callable[[str], Path], need: Callable[[str], None]) -> Path:
    """The FMU of the kind that a test names."""
    need(request.param)
    return built(request.param)


def held(fmu: Path, name: str) -> Columns:
    """A manoeuvre through `fmpy.simulate_fmu`, which holds inputs over each communication step."""
    manoeuvre = manoeuvres.load(name)
    signals = np.array(
        list(zip(manoeuvre.time, *manoeuvre.inputs.values(), strict=True)),
        [(n, np.double) for n in ("time", *manoeuvre.inputs)],
    )
    rows = fmpy.simulate_fmu(
        str(fmu),
        stop_time=manoeuvre.stop_time,
        output_interval=H,
        start_values=accuracy.start_of_fmu(name) | {"step_size": H},
        input=signals,
        output=list(trajectories.SENSORS),
    )
    return sampled(rows, name)


def sampled(rows: Columns, name: str) -> Columns:
    """Rows of communication points at the times of the reference."""
    every = round(manoeuvres.sampling(name) / H)
    return {n: np.asarray(rows[n])[::every] for n in trajectories.SENSORS}


def late(name: str, lag: float) -> Columns:
    """The manoeuvre in the kernel with inputs that are late by `lag`, s."""
    h, manoeuvre = 0.2 * H, manoeuvres.load(name)
    delayed: Manoeuvre = replace(manoeuvre, time=manoeuvre.time + lag)
    every = round(manoeuvres.sampling(name) / h)
    found = manoeuvres.run_on(manoeuvres.system_of(name), delayed, h, every=every)
    return {n: np.asarray(found[n]) for n in trajectories.SENSORS}


def beyond(name: str, found: Mapping[str, float], bounds: tuple[float, float]) -> list[str]:
    """The errors of a manoeuvre above the bounds of the place and of the others, as lines."""
    place, other = bounds
    return [f"{name}: {g} {e:.2e}" for g, e in found.items() if not e <= (place if g == "place" else other)]


def of_kinds(*kinds: str) -> pytest.MarkDecorator:
    return pytest.mark.parametrize("car", kinds, indirect=True)


@of_kinds("native", "python")
def test_with_input_derivatives_an_fmu_is_as_accurate_as_the_kernel(car: Path) -> None:
    wrong = []
    for name in NAMES:
        _, reference, length = trajectories.read(name)
        found = errors(accuracy.run_of_fmu(car, name, H, follow=True), reference, length)
        wrong += beyond(name, found, BOUNDS[name])
    assert not wrong, "\n".join(wrong)


@of_kinds("native")
def test_with_input_derivatives_errors_fall_with_the_square_of_the_step(car: Path) -> None:
    wrong = []
    for name in ("slalom", "steady_cornering", "double_lane_change_replay"):
        _, reference, length = trajectories.read(name)
        coarse, fine = (
            errors(accuracy.run_of_fmu(car, name, h, follow=True), reference, length)["wheel load"]
            for h in (H, 0.25 * H)
        )
        order = float(np.log2(coarse / fine)) / 2.0
        if not 1.7 < order < 2.4:
            wrong.append(f"{name}: order {order:.2f}")
    assert not wrong, "\n".join(wrong)


@pytest.fixture(scope="module")
def lagging() -> dict[str, Columns]:
    """Manoeuvres in the kernel with inputs that are late by half a communication step."""
    return {name: late(name, 0.5 * H) for name in LEFT}


@pytest.mark.filterwarnings("ignore:missing input")
@of_kinds("native", "fmi3_scalar", "python")
def test_held_inputs_are_late_by_half_a_communication_step(car: Path, lagging: dict[str, Columns]) -> None:
    """Against the reference an FMU errs by that lag; against the kernel with that lag it errs much less."""
    wrong = []
    for name, expected in lagging.items():
        _, reference, length = trajectories.read(name)
        found, lag = held(car, name), errors(expected, reference, length)
        wrong += beyond(f"{name}, all", errors(found, reference, length), (1.3 * lag["place"], 1.3 * max(lag.values())))
        wrong += beyond(f"{name}, left", errors(found, expected, length), LEFT[name])
    assert not wrong, "\n".join(wrong)


@of_kinds("native")
def test_wheel_loads_at_rest_are_those_of_the_lever_rule(car: Path) -> None:
    with Fmu(car) as fmu:
        fmu.initialise({"brake": 1.0})
        get = fmu.getter(trajectories.LOADS)
        begin = get()
        for k in range(100):
            fmu.step(k * H, H)
        end = get()
    front, rear = statics.wheel_loads()
    for loads in (begin, end):
        assert loads == pytest.approx([front, front, rear, rear], rel=1e-4)


@of_kinds("native")
def test_a_steady_turn_is_a_circle_with_its_centripetal_acceleration(car: Path) -> None:
    """The circle through the last places; speed, yaw rate and lateral acceleration are outputs of their own."""
    names = ("chassis.x", "chassis.y", "speed", "chassis.wz", "chassis.ay")
    rows = accuracy.run_of_fmu(car, "steady_cornering", H, follow=False)
    x, y, speed, rate, lateral = (np.asarray(rows[n])[-60:] for n in names)
    unit = np.column_stack([x, y, np.ones_like(x)])
    (a, b, c), *_ = np.linalg.lstsq(unit, x**2 + y**2, rcond=None)
    radius = float(np.sqrt(c + 0.25 * (a**2 + b**2)))
    assert np.ptp(x) > 5.0
    assert speed / rate == pytest.approx(radius, rel=1e-2)
    assert lateral == pytest.approx(speed**2 / radius, rel=1e-2)
