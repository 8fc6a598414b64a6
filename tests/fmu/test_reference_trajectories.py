"""FMPy drives FMUs of the prototype car over its reference trajectories, and over motions known without them."""

import importlib.util
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TypeAlias

import fmpy
import numpy as np
import pytest
from numpy.typing import NDArray

from ali3.low_pass import low_pass
from benchmarks.car import fidelity_runs, manoeuvres, statics, trajectories
from benchmarks.car.fmu_runs import run_of_fmu, start_of_fmu
from fmu_src.build.build import build_fmu
from hosts.common.numbers import Value
from hosts.driving.co_simulation import run
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.random_driver import RandomDriver, random_start
from hosts.fmu.fmu import Fmu
from hosts.fmu.scalars import ELEMENTS, element_names
from mbs import Pose, Simulation
from mbs.vehicle.environment import GRAVITY
from tests import kinds
from tests.fmu.other_hosts import by_c_host, by_libcosim
from tests.quick import quick

Columns: TypeAlias = Mapping[str, NDArray[np.float64]]

H = 0.01  # s, communication and inner step
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
    "step_steer_given_throttle": (2e-6, 0.006),
    "slalom": (1e-5, 0.0015),
    "drop": (3e-3, 0.14),
    "steady_cornering": (2e-6, 1.5e-4),
    "double_lane_change_replay": (3e-6, 0.001),
    "full_lock": (2e-4, 0.015),
    "kerb_lock_brake": (8e-4, 0.33),
    "brake_on_slope": (2e-5, 0.01),
}
HATCHBACK = BOUNDS | {"steady_cornering": (3e-6, 1.5e-3), "drop": (9e-3, 0.35), "kerb_drop": (5e-4, 0.28)}
# The same for held inputs against the kernel with inputs that are late by half a communication step, of the manoeuvres
# whose inputs change.
LEFT = {
    "launch_and_brake": (3e-4, 0.013),
    "step_steer_given_throttle": (2.2e-5, 0.006),
    "slalom": (8e-6, 0.0015),
    "steady_cornering": (7e-6, 1.5e-4),
    "double_lane_change_replay": (4e-6, 0.001),
    "full_lock": (7e-4, 0.015),
    "kerb_lock_brake": (7e-4, 0.5),
    "brake_on_slope": (2e-5, 0.02),
}
# In each run; the others are slow.
FEW = ("drop", "slalom", "launch_and_brake", "double_lane_change_replay", "kerb_lock_brake")
# Of those whose inputs do not change, which every host can give at the start.
CONSTANT = ("drop", "kerb_drop")
Road: TypeAlias = Callable[[str], Path]


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
def built(made_once: Callable[[str, Callable[[Path], None]], Path]) -> Callable[..., Path]:
    """A car as an FMU of a kind, on its own road or that of the manoeuvre of this name, built once."""

    def build(kind: str, road: str, car: str = manoeuvres.PROTOTYPE) -> Path:
        def fill(folder: Path) -> None:
            build_fmu(manoeuvres.system_of(road or "drop", car), f"{car}_car", folder, [fmpy.platform], kind=kind)

        (path,) = made_once(f"driven_{car}_{kind}_{road}", fill).glob("*.fmu")
        return path

    return build


@pytest.fixture
def car(request: pytest.FixtureRequest, built: Callable[..., Path], need: Callable[[str], None]) -> Road:
    """The FMU of the kind that a test names, for a manoeuvre."""
    need(request.param)
    return lambda name: built(request.param, name if name in manoeuvres.OTHER_ROAD else "")


def held(fmu: Path, name: str) -> Columns:
    """A manoeuvre through `fmpy.simulate_fmu`, which holds inputs over each communication step."""
    manoeuvre = manoeuvres.load(name)
    signals = np.array(
        list(zip(manoeuvre.time, *manoeuvre.inputs.values(), strict=True)),
        [(n, np.double) for n in ("time", *manoeuvre.inputs)],
    )
    with zipfile.ZipFile(fmu) as archive:
        text = archive.read(ELEMENTS).decode() if ELEMENTS in archive.namelist() else ""
    places = {e: (array, k) for array, elements in element_names(text).items() for k, e in enumerate(elements)}
    rows = fmpy.simulate_fmu(
        str(fmu),
        stop_time=manoeuvre.stop_time,
        output_interval=H,
        start_values=start_of_fmu(name) | {"step_size": H},
        input=signals,
        output=list(dict.fromkeys(places.get(n, (n, 0))[0] for n in trajectories.SENSORS)),
    )
    columns = {n: rows[n] for n in trajectories.SENSORS if n not in places}
    return sampled(columns | {e: rows[a][:, k] for e, (a, k) in places.items() if a in rows.dtype.names}, name)


def sampled(rows: Columns, name: str) -> Columns:
    """Rows of communication points at the times of the reference."""
    every = round(manoeuvres.sampling(name) / H)
    return {n: np.asarray(rows[n])[::every] for n in trajectories.SENSORS}


def late(name: str, lag: float) -> Columns:
    """The manoeuvre in the kernel with inputs that are late by `lag`, s."""
    h, manoeuvre = 0.2 * H, manoeuvres.load(name)
    delayed: Manoeuvre = replace(manoeuvre, time=manoeuvre.time + lag)
    every = round(manoeuvres.sampling(name) / h)
    result = manoeuvres.run_on(manoeuvres.system_of(name), delayed, h, every=every)
    return {n: np.asarray(result[n]) for n in trajectories.SENSORS}


def beyond(name: str, found: Mapping[str, float], bounds: tuple[float, float]) -> list[str]:
    """The errors of a manoeuvre above the bounds of the place and of the others, as lines."""
    place, other = bounds
    return [f"{name}: {g} {e:.2e}" for g, e in found.items() if not e <= (place if g == "place" else other)]


def of_kinds(first: str, *others: str) -> pytest.MarkDecorator:
    """By kind of FMU; the others, which have the bits of the first (`test_native_agreement.py`), in the proof run."""
    proof = [pytest.param(kind, marks=pytest.mark.proof) for kind in others]
    return pytest.mark.parametrize("car", [first, *proof], indirect=True)


@of_kinds("native")
@pytest.mark.parametrize("name", quick(FEW, manoeuvres.NAMES))
def test_with_input_derivatives_an_fmu_is_as_accurate_as_the_kernel(car: Road, name: str) -> None:
    _, reference, length = trajectories.read(name)
    found = errors(run_of_fmu(car(name), name, H, follow=True), reference, length)
    assert beyond(name, found, BOUNDS[name]) == []


@pytest.mark.proof
def test_with_input_derivatives_the_hatchback_is_as_accurate(built: Callable[..., Path]) -> None:
    wrong = []
    for name in manoeuvres.NAMES:
        _, reference, length = trajectories.read(name, "hatchback")
        fmu = built("native", name if name in manoeuvres.OTHER_ROAD else "", "hatchback")
        wrong += beyond(name, errors(run_of_fmu(fmu, name, H, True, "hatchback"), reference, length), HATCHBACK[name])
    assert not wrong, "\n".join(wrong)


@of_kinds("native")
@pytest.mark.slow
def test_with_input_derivatives_errors_fall_with_the_square_of_the_step(car: Road) -> None:
    wrong = []
    for name in ("slalom", "double_lane_change_replay"):
        _, reference, length = trajectories.read(name)
        coarse, fine = (
            errors(run_of_fmu(car(name), name, h, follow=True), reference, length)["wheel load"] for h in (H, 0.25 * H)
        )
        order = float(np.log2(coarse / fine)) / 2.0
        if not 1.7 < order < 2.4:
            wrong.append(f"{name}: order {order:.2f}")
    assert not wrong, "\n".join(wrong)


@pytest.fixture(scope="module")
def lagging() -> dict[str, Columns]:
    """Manoeuvres in the kernel with inputs that are late by half a communication step."""
    return {name: late(name, 0.5 * H) for name in LEFT}


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:missing input")
@of_kinds(*kinds.ALL)
def test_held_inputs_are_late_by_half_a_communication_step(car: Road, lagging: dict[str, Columns]) -> None:
    """Against the reference an FMU errs by that lag; against the kernel with that lag it errs much less."""
    wrong = []
    for name, expected in lagging.items():
        _, reference, length = trajectories.read(name)
        results, lag = held(car(name), name), errors(expected, reference, length)
        wrong += beyond(
            f"{name}, all", errors(results, reference, length), (1.3 * lag["place"], 1.3 * max(lag.values()))
        )
        wrong += beyond(f"{name}, left", errors(results, expected, length), LEFT[name])
    assert not wrong, "\n".join(wrong)


@of_kinds("native")
def test_wheel_loads_at_rest_are_those_of_the_lever_rule(car: Road) -> None:
    with Fmu(car("drop")) as fmu:
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
def test_a_steady_turn_is_a_circle_with_its_centripetal_acceleration(car: Road) -> None:
    """The circle through the last places; speed, yaw rate and lateral acceleration are outputs of their own."""
    names = ("chassis.x", "chassis.y", "speed", "chassis.wz", "chassis.ay")
    rows = run_of_fmu(car("steady_cornering"), "steady_cornering", H, follow=False)
    x, y, speed, rate, lateral = (np.asarray(rows[n])[-60:] for n in names)
    unit = np.column_stack([x, y, np.ones_like(x)])
    (a, b, c), *_ = np.linalg.lstsq(unit, x**2 + y**2, rcond=None)
    radius = float(np.sqrt(c + 0.25 * (a**2 + b**2)))
    assert np.ptp(x) > 5.0
    assert speed / rate == pytest.approx(radius, rel=1e-2)
    assert lateral == pytest.approx(speed**2 / radius, rel=1e-2)


@of_kinds("native")
def test_in_the_air_behind_a_kerb_the_centre_of_mass_falls(car: Road) -> None:
    """A parabola: the second difference of the energy of gravity is that of the weight, without the drag of the air."""
    start: dict[str, Value] = {
        "initial.speed": 20.0,
        "road.kerb_x": 7.5,
        "road.kerb_height": 0.5,
        "aerodynamics.drag_area": 0.0,
    }
    with Fmu(car("drop")) as fmu:
        rows = run(fmu, Manoeuvre("flight", np.zeros(0), {}, 1.0, start | {"step_size": 0.2 * H}), 0.2 * H)
    air = np.flatnonzero(np.all([rows[n] == 0.0 for n in trajectories.LOADS], axis=0))
    assert np.ptp(air) + 1 == len(air) > 50
    fall = np.diff(rows["energy.gravity"][air], 2) / (0.2 * H) ** 2
    assert fall == pytest.approx(np.full(len(fall), -2.0 * sum(statics.wheel_loads()) * GRAVITY), rel=1e-4)


@pytest.mark.slow
@of_kinds("native")
@pytest.mark.parametrize("seed", quick((4,), (1, 4, 5), "proof"))
def test_a_random_drive_is_that_of_the_kernel_with_small_steps(car: Road, seed: int) -> None:
    start = {n: x for n, x in random_start(seed).items() if n not in ("initial.x", "initial.y")}
    with Fmu(car("drop")) as fmu:
        inputs = fmu.names("input")
        wild = Manoeuvre("wild", np.zeros(0), {}, 4.0, start | {"step_size": 0.2 * H})
        rows = run(fmu, wild, H, RandomDriver(seed, inputs))
    pose = Pose(**{n.removeprefix(manoeuvres.INITIAL): float(x) for n, x in start.items()})
    kernel = Simulation(manoeuvres.system_of("drop"), pose=pose)
    results = []
    for row in rows.values[:, [rows.names.index(n) for n in inputs]].tolist():
        sensors = kernel.sensors
        results.append([sensors[n] for n in trajectories.SENSORS])
        for name, value in zip(inputs, row, strict=True):
            kernel.set_input(name, value)
        kernel.step(0.05 * H, 20)
    reference = dict(zip(trajectories.SENSORS, np.array(results).T, strict=True))
    length = float(np.linalg.norm(np.diff([reference[n] for n in trajectories.POSITION], axis=1), axis=0).sum())
    wrong = beyond(f"seed {seed}", errors({n: rows[n] for n in reference}, reference, length), (1e-3, 0.03))
    assert not wrong, "\n".join(wrong)


def test_moments_and_stresses_of_the_kerb_in_every_kind(kerb_fmus: Path) -> None:
    """15 s with the frame in quasi-static equilibrium, against 106 modes; the same bits in both versions of FMI."""
    stresses = tuple(n.replace("bending_moment", "stress") for n in fidelity_runs.MOMENTS)
    names = (*fidelity_runs.POSITION, *fidelity_runs.LOADS, *fidelity_runs.MOMENTS, *stresses)
    rows = {}
    for file in sorted(kerb_fmus.glob("*.fmu")):
        manoeuvre = Manoeuvre("kerb", np.zeros(0), {}, 15.0, {"fidelity": 1, "step_size": H})
        with Fmu(file) as fmu:
            rows[file.stem] = run(fmu, manoeuvre, H)
    actual = {n: rows["native"][n] for n in names}
    assert all(np.array_equal(actual[n], other[n]) for other in rows.values() for n in names)
    reference = fidelity_runs.read_reference("kerb_test")
    for n, low in ((n, low_pass(actual[n], H, fidelity_runs.FREQUENCY)) for n in fidelity_runs.MOMENTS):
        actual[fidelity_runs.FILTERED + n] = low
    error = fidelity_runs.errors(actual, reference)
    assert error["moment"] < 0.05
    assert error["wheel_load"] < 0.1
    assert error["motion"] < 2e-3
    outer, wall = 0.04, 0.002  # m, of the tubes with gauges
    for moment, stress in zip(fidelity_runs.MOMENTS, stresses, strict=True):
        across = outer / (np.pi / 64.0 * (outer**4 - (outer - 2.0 * wall) ** 4))  # between upper and lower fibre
        assert actual[stress] == pytest.approx(across * actual[moment], rel=1e-9)


@pytest.mark.slow
@of_kinds("native")
def test_a_host_in_c_and_libcosim_run_the_references_of_constant_inputs(car: Road, tmp_path: Path) -> None:
    wrong = []
    for name in CONSTANT:
        _, reference, length = trajectories.read(name)
        manoeuvre = manoeuvres.load(name)
        start = {**start_of_fmu(name), **manoeuvre.at(0.0), "step_size": H}
        steps = round(manoeuvre.stop_time / H)
        through = {"C": by_c_host(car("drop"), tmp_path, start, trajectories.SENSORS, steps, H)}
        if importlib.util.find_spec("libcosimpy") is not None:
            through["libcosim"] = by_libcosim(car("drop"), {}, trajectories.SENSORS, steps, H, start)
        every = round(manoeuvres.sampling(name) / H)
        behind = {n: x[1:] for n, x in reference.items()}
        for which, rows in through.items():
            result = dict(zip(trajectories.SENSORS, rows[every - 1 :: every].T, strict=True))
            wrong += beyond(f"{which}, {name}", errors(result, behind, length), BOUNDS[name])
    assert not wrong, "\n".join(wrong)


@pytest.mark.slow
def test_inputs_that_are_given_within_steps_of_fmi_3_are_as_right_as_derivatives(built: Callable[..., Path]) -> None:
    """At 10 ms: within twice the errors of FMI 2.0 with derivatives, a tenth of those of held inputs."""
    _, reference, length = trajectories.read("slalom")
    results = {}
    for kind, follow in (("native", True), ("fmi3_scalar", True), ("fmi3_scalar", False)):
        columns = run_of_fmu(built(kind, ""), "slalom", 0.01, follow)
        results[kind, follow] = trajectories.path_error(columns, reference) / length
    assert results["fmi3_scalar", True] < 2.0 * results["native", True]
    assert results["fmi3_scalar", True] < 0.1 * results["fmi3_scalar", False]
