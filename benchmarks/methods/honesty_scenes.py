"""The scenes of `benchmarks.honesty`, each with the exact values of its compared sensors."""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

import mbs
from benchmarks.car import manoeuvres
from benchmarks.methods.kernel_methods import KERNEL, suits
from benchmarks.methods.true_error import true_error
from benchmarks.references.cases import CASES, SAMPLES, Array, exact_of, system_of
from mbs.results.comparison import compared_sensors

PAGE = Path(__file__).resolve().parents[2] / "docs" / "modelling.md"
CLOSE = 1e-3
"""Largest relative difference of a fine run from exact motions; the run replaces them for other sensors."""
CRANK_ANGLE = 758.62661  # rad after 2 s: its one degree of freedom under DOP853 at 1e-12
TUMBLING = np.diag([0.1, 0.2, 0.3]), np.array([0.01, 5.0, 0.01])  # kg m2, rad/s: near the axis of intermediate inertia
TUMBLING_TIME = 20.0  # s
CAR_STEP = 2.5e-4  # s
BEST = {
    "pendulum": ("runge_kutta_8", 40),
    "pendulum_1000s": ("runge_kutta_8", 2000),
    "double_four_bar": ("semi_recursive_4", 200),
    "four_bar_40": ("energy_momentum_4", 40),
    "four_bar_200": ("radau_5", 100),
    "squeezer": ("runge_kutta_8", 20),
    "bricard": ("semi_recursive", 20),
    "flyball": ("radau_5", 40),
    "slider_crank": ("radau_5", 200),
    "spatial_slider_crank": ("runge_kutta_8", 100),
    "bicycle": ("runge_kutta_8", 20),
    "spatial_chain": ("semi_recursive", 40),
}
"""Most accurate method, and steps between samples, for sensors without an exact motion."""


@dataclass(frozen=True)
class Scene:
    """A model with the exact values of sensors at equal instants."""

    run: Callable[..., mbs.Trajectory]
    """Returns the trajectory of a method with a step, s, recorded at the instants; further arguments of
    `mbs.simulate`.
    """
    reference: Callable[[], Mapping[str, Array]]
    """Returns exact values by sensor."""
    system: Callable[[], mbs.System]
    """Returns the System, whose length is the scale of sensors at rest."""
    methods: Callable[[], list[str]]
    """Returns the names of the methods that can simulate it."""
    steps: tuple[float, ...]
    """Steps in descending order, s."""

    def error(self, trajectory: mbs.Trajectory) -> float:
        """Largest error of a compared sensor relative to its size."""
        assert trajectory.report is not None
        return true_error(self.system(), self.reference(), trajectory, trajectory.report.energy_floor)


def _record(system: mbs.System, end: float, method: str, h: float, **more: Any) -> mbs.Trajectory:
    """Simulate a System, recorded at `SAMPLES` equal instants."""
    every = max(1, round(end / SAMPLES / h))
    return mbs.simulate(system, end, h, method=method, every=every, progress=False, **more)


def _case_run(name: str, method: str, h: float, **more: Any) -> mbs.Trajectory:
    return _record(system_of(name), CASES[name].end, method, h, **more)


@cache
def _case_reference(name: str) -> dict[str, Array]:
    case, exact = CASES[name], exact_of(name)
    known = dict(zip(case.sensors, exact.T, strict=True))
    if name not in BEST:
        return known
    method, division = BEST[name]
    best = _case_run(name, method, case.end / (SAMPLES * division), estimate_error=False)
    for sensor, values in known.items():
        assert np.abs(best[sensor] - values).max() < CLOSE * np.ptp(exact), f"{name}: {sensor}"
    return {n: best[n] for n in compared_sensors(system_of(name))} | known


def _case(name: str) -> Scene:
    case = CASES[name]
    return Scene(
        partial(_case_run, name),
        partial(_case_reference, name),
        partial(system_of, name),
        lambda: [m for m in KERNEL if suits(m, case.conservative, system_of(name))],
        tuple(case.end / (SAMPLES * d) for d in case.divisions),
    )


@cache
def printed_model() -> mbs.System:
    """The crank-slider from the code in `docs/modelling.md`."""
    block = re.search(r"```python\n(.*?)\nsystem = ", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    assert block is not None
    names: dict[str, Any] = {}
    exec(block[1], names)
    return mbs.compile(names["m"])


def _crank_run(method: str, h: float, **more: Any) -> mbs.Trajectory:
    return _record(printed_model(), 2.0, method, h, inputs={"torque": 4.0}, **more)


@cache
def _crank_reference() -> dict[str, Array]:
    best = _crank_run("runge_kutta_8", 6.25e-5, estimate_error=False)
    assert abs(best["crank.angle"][-1] - CRANK_ANGLE) < 1e-4
    return {n: best[n] for n in ("crank.angle", "piston.x")}


@cache
def tumbling_body() -> mbs.System:
    """A free body near its axis of intermediate inertia: small errors change the times at which it turns over."""
    m = mbs.Model("tumbling body", gravity=(0.0, 0.0, 0.0))
    body = m.body("body", mass=1.0, com=(0.0, 0.0, 0.0), inertia=TUMBLING[0])
    m.initial_velocity(body, linear=(0.0, 0.0, 0.0), angular=TUMBLING[1])
    for c in "xyz":
        m.sense_rotation(f"rate.{c}", body, c, order=1)
        m.sense_position(f"tip.{c}", body, (0.0, 1.0, 0.0), c)
    return mbs.compile(m)


def _tumbling_run(method: str, h: float, **more: Any) -> mbs.Trajectory:
    return _record(tumbling_body(), TUMBLING_TIME, method, h, **more)


@cache
def _tumbling_reference() -> dict[str, Array]:
    """Positions of the tip, m, by Euler's equations, the rotation matrix and DOP853."""
    inertia, rate = TUMBLING

    def rates(_: float, x: Array) -> Array:
        w, axes = x[:3], x[3:].reshape(3, 3)
        turn = np.array([[0.0, -w[2], w[1]], [w[2], 0.0, -w[0]], [-w[1], w[0], 0.0]])
        return np.concatenate([np.linalg.solve(inertia, -np.cross(w, inertia @ w)), (axes @ turn).ravel()])

    start = np.concatenate([rate, np.eye(3).ravel()])
    t = np.linspace(0.0, TUMBLING_TIME, SAMPLES + 1)
    x = solve_ivp(rates, (0.0, TUMBLING_TIME), start, t_eval=t, method="DOP853", rtol=1e-12, atol=1e-13).y
    return {f"tip.{c}": x[4 + 3 * k] for k, c in enumerate("xyz")}


def _car_run(name: str, method: str, h: float, **more: Any) -> mbs.Trajectory:
    every = round(manoeuvres.sampling(name) / h)
    more.setdefault("estimate_error", None)
    return manoeuvres.run(name, h, every=every, settings=mbs.Settings(method=method), **more)


@cache
def _car_reference(name: str) -> dict[str, Array]:
    """Sensors of a run of the default method whose difference from the stored references is below 1e-4."""
    every = round(manoeuvres.sampling(name) / CAR_STEP)
    fine = manoeuvres.run(name, CAR_STEP, every=every)
    return {n: fine[n] for n in compared_sensors(manoeuvres.system_of(name))}


def _car(name: str) -> Scene:
    sampling = manoeuvres.sampling(name)
    steps = tuple(h for h in (0.02, 0.01, 0.005, 0.002, 0.001) if abs(round(sampling / h) * h - sampling) < 1e-9 * h)
    return Scene(
        partial(_car_run, name),
        partial(_car_reference, name),
        partial(manoeuvres.system_of, name),
        lambda: ["ali3p", "ali3p_no_projection", "ali3p_generalised_alpha", "energy_momentum"],
        steps,
    )


SCENES: dict[str, Scene] = {
    **{name: _case(name) for name in CASES},
    "printed_crank_slider": Scene(
        _crank_run,
        _crank_reference,
        printed_model,
        lambda: [m for m in KERNEL if suits(m, True, printed_model())],
        (2e-3, 1e-3, 5e-4, 2.5e-4, 1.25e-4, 6.25e-5, 2e-5),
    ),
    "tumbling_body": Scene(
        _tumbling_run,
        _tumbling_reference,
        tumbling_body,
        lambda: [m for m in KERNEL if suits(m, True, tumbling_body())],
        (0.02, 0.01, 0.005, 0.0025, 0.001, 0.0005, 0.0002),
    ),
    **{f"car, {name}": _car(name) for name in manoeuvres.NAMES},
}
