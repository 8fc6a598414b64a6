"""Runs of the engine: scenes, methods, steps, settings and tolerances, with all that the state and the sensors hold."""

import math
import warnings
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
from scipy.special import ellipk

import mbs
from mbs import SimulationError
from tests.bits import doors, models
from tests.bits.store import Entry, entry_of

METHODS = (
    *("ali3p", "ali3p_no_projection", "ali3p_generalised_alpha", "energy_momentum", "energy_momentum_4"),
    *("runge_kutta_8", "semi_recursive", "semi_recursive_4", "radau_5"),
)
OTHERS: dict[str, dict[str, Any]] = {
    "paper_update": {"update": "paper", "tolerance_r": 1e-8},
    "acceleration_predictor": {"predictor": "acceleration"},
    "not_geometric": {"geometric": False},
    "two_iterations": {"step_iterations": 2},
    "penalty": {"alpha": 1e10},
    "regularised": {"eps_rel": 1e-5, "tolerance_phi": 1e-9},
    "loose": {"tolerance_r": 1e-7, "tolerance_phi": 1e-8, "max_iterations": 12, "max_halvings": 2},
    "damped": {"method": "ali3p_generalised_alpha", "rho_infinity": 0.2},
}
"""Settings of runs beside those of the methods."""


@dataclass(frozen=True)
class Scene:
    """A model and how it is run."""

    make: Callable[[], mbs.Model]
    """Gives the model."""
    h: float = 0.005
    steps: int = 100
    """`h`, `steps`: of its runs, s."""
    inputs: Mapping[str, Callable[[float], float]] = field(default_factory=dict)
    """Over time, s."""
    pose: mbs.Pose | None = None
    """Where it starts."""
    methods: tuple[str, ...] = METHODS
    """That are tried; a method that refuses the scene is stored as refused."""
    tolerance: float = 0.0
    """Of a run that chooses its steps; 0: none."""
    others: bool = False
    """Whether it is run with `OTHERS` and with other steps."""
    exact: bool = True
    """Whether bits are compared: not where eigenvectors of LAPACK are in the model."""


def _wave(size: float, rate: float, shift: float = 0.0) -> Callable[[float], float]:
    """A triangle wave: exact on every platform."""
    return lambda t: size * (2.0 * abs(2.0 * ((rate * t + shift) % 1.0) - 1.0) - 1.0)


PEDALS = {
    "steering": lambda t: 0.2 * min(t / 0.1, 1.0),
    "throttle": lambda t: 0.6 if t < 0.5 else 0.0,
    "brake": lambda t: 0.0 if t < 0.6 else 0.7,
}
PUSHES = {name: _wave(6.0, 3.0 + k, 0.1 * k) for k, name in enumerate(("push.x", "push.y", "push.z", "turn"))}
CAR = ("ali3p", "ali3p_generalised_alpha", "energy_momentum", "radau_5")  # the others refuse tyres


def _scenes() -> dict[str, Scene]:
    scenes = {
        "pendulum": Scene(partial(doors.scene, "pendulum"), 0.01, 100, tolerance=1e-5, others=True),
        "slider_crank": Scene(partial(doors.scene, "slider_crank"), tolerance=1e-4, steps=400),
        "double_four_bar": Scene(partial(doors.scene, "double_four_bar"), 0.01, 120, tolerance=1e-4, others=True),
        "double_four_bar_40": Scene(partial(doors.scene, "double_four_bar", windows=40), 0.01, 50),
        "bricard": Scene(partial(doors.scene, "bricard"), 0.01, tolerance=1e-4, others=True),
        "flyball": Scene(partial(doors.scene, "flyball"), tolerance=1e-4),
        "squeezer": Scene(partial(doors.scene, "squeezer"), 1e-4, 200, tolerance=1e-4),
        "cart_pole": Scene(partial(doors.scene, "cart_pole"), 0.002, 300, tolerance=1e-4),
        "spatial_slider_crank": Scene(partial(doors.scene, "spatial_slider_crank"), 0.01, 150, tolerance=1e-4),
        "spatial_chain": Scene(partial(doors.scene, "spatial_chain"), 0.005),
        "puma": Scene(partial(doors.scene, "puma"), 0.01, 150, tolerance=1e-3, others=True),
        "bicycle": Scene(partial(doors.scene, "bicycle"), 0.01, 150, tolerance=1e-4),
        "spinning_beam": Scene(partial(doors.scene, "spinning_beam", parts=2), 0.005, exact=False),
        "assembly_defect": Scene(partial(doors.scene, "assembly_defect_four_bar"), 0.01, 60, exact=False),
        "four_bar": Scene(partial(doors.example, "four_bar", "double_four_bar"), 0.01, 80),
        "quarter_car": Scene(partial(doors.example, "quarter_car", "quarter_car"), tolerance=1e-4),
        "robot_arm": Scene(partial(doors.example, "robot_arm", "robot_arm"), tolerance=1e-4),
        "rolling_disc": Scene(partial(doors.example, "rolling_disc", "disc", 6.0), tolerance=1e-4, steps=200),
        "flexible_beam": Scene(partial(doors.example, "flexible_beam", "flexible_beam"), 0.01, 60, exact=False),
        "arm": Scene(models.arm, 0.005, 120, PUSHES, others=True),
        "planar": Scene(
            models.planar, 0.005, 160, {"pull": lambda t: 0.5 if t > 0.1 else 0.0, "torque": _wave(5.0, 2.0)}
        ),
        "gears": Scene(models.gears, 0.005, 160, {"hand": _wave(4.0, 1.5, 0.25)}),
        "roller": Scene(models.roller, 0.005, 160, {"torque": _wave(2.0, 1.0)}),
        "skater": Scene(models.skater, 0.01, tolerance=1e-4),
        "triangle": Scene(models.triangle, 0.005, 160, others=True),
    }
    for name, road in models.SLEDGES.items():
        make = partial(_sledge, road)
        scenes[name] = Scene(make, 0.002, 400, pose=mbs.Pose(0.1, 0.2, 0.05, 0.3, 2.0), methods=CAR)
    for fidelity in range(4):
        for car in ("prototype", "hatchback"):
            start, methods = mbs.Pose(1.0, -0.5, 0.02, 0.2, 8.0), CAR if fidelity == 0 else CAR[:2]
            name = f"{car}_{fidelity}"
            scenes[name] = Scene(
                partial(doors.car, car, fidelity), 0.005, 200, PEDALS, start, methods, others=name == "prototype_0"
            )
        make = partial(doors.scene, "kerb_test", fidelity=fidelity)
        scenes[f"kerb_test_{fidelity}"] = Scene(make, 0.01, 150, methods=CAR[:1] if fidelity else CAR)
    return scenes


def _sledge(road: Callable[[], Any]) -> mbs.Model:
    return models.sledge(road())


SCENES = _scenes()


def scene_runs(name: str) -> Iterator[tuple[str, Entry]]:
    """All runs of a scene, and what is computed from its System without one."""
    scene = SCENES[name]
    system = mbs.compile(scene.make())
    runs: dict[str, tuple[float, int, mbs.Settings | dict[str, Any]]] = {
        method: (scene.h, scene.steps, {"method": method}) for method in scene.methods
    }
    if scene.others:
        runs |= {key: (scene.h, scene.steps, settings) for key, settings in OTHERS.items()}
        runs |= {"half_step": (0.5 * scene.h, scene.steps, {}), "double_step": (2.0 * scene.h, scene.steps // 2, {})}
    for key, (h, steps, settings) in runs.items():
        yield f"run/{name}/{key}", entry_of(_stepped(system, scene, h, steps, mbs.Settings(**settings)), scene.exact)
    if scene.tolerance:
        for key, extra in {"tolerance": {}, "tolerance_radau_5": {"method": "radau_5"}}.items():
            yield f"run/{name}/{key}", entry_of(_chosen(system, scene, **extra), scene.exact)


def _stepped(system: mbs.System, scene: Scene, h: float, steps: int, settings: mbs.Settings) -> dict[str, Any]:
    """Signals of a run in equal steps; one that is refused or fails keeps what was there before."""
    rows: dict[str, list[Any]] = {name: [] for name in ("q", "qd", "qdd", "lam", "y")}
    sensors: list[list[float]] = []
    names: list[str] = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            start = {name: at(0.0) for name, at in scene.inputs.items()}
            simulation = mbs.Simulation(system, settings=settings, inputs=start, pose=scene.pose)
            names = list(simulation.sensors)
            for k in range(steps + 1):
                if k:
                    for name, at in scene.inputs.items():
                        simulation.set_input(name, at(k * h))
                    simulation.step(h)
                state = simulation.state
                for part, kept in rows.items():
                    kept.append(getattr(state, part))
                sensors.append(list(simulation.sensors.values()))
        except SimulationError:
            pass  # counts as a run that ends here
    signals: dict[str, Any] = {part: np.array(kept) for part, kept in rows.items()}
    signals |= {f"sensor {name}": column for name, column in zip(names, np.array(sensors).T, strict=True)}
    return signals


def _chosen(system: mbs.System, scene: Scene, **extra: Any) -> dict[str, Any]:
    """Signals of a run that keeps a tolerance, with poses and what is told of its errors."""
    t_end = scene.h * scene.steps
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            run = mbs.simulate(system, t_end, tolerance=scene.tolerance, h=t_end / 20.0, progress=False, **extra)
        except (SimulationError, ValueError):
            return {"refused": 1.0}
    signals: dict[str, Any] = {"time": run.t} | {f"sensor {name}": values for name, values in run.items()}
    signals |= {f"pose {name}": values for name, values in run.poses.items()}
    return signals | {"error": run.control.error if run.control is not None else math.nan}


def analyses() -> Iterator[tuple[str, Entry]]:
    """Repeated runs, linear models, Floquet multipliers, switches, parameters and equilibria."""
    arm = mbs.compile(models.arm())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        run = mbs.simulate(mbs.compile(doors.scene("double_four_bar")), 1.0, 0.02, estimate_error=True, progress=False)
        yield "analysis/repeated_run", entry_of(_fields(run.accuracy))
        run = mbs.simulate(mbs.compile(doors.scene("pendulum")), 1.0, progress=False)
        yield "analysis/chosen_step", entry_of({"time": run.t} | dict(run))
        simulation = mbs.Simulation(arm, parameters={"load": 0.8})
        run = simulation.run(0.3, 0.005, inputs={"push.z": ([0.0, 0.1, 0.3], [0.0, 9.0, -9.0])}, every=3)
        yield "analysis/other_parameter", entry_of(dict(run) | {f"pose {k}": v for k, v in run.poses.items()})
        saved = simulation.save()
        first = simulation.run(0.4, 0.01)
        simulation.restore(saved)
        yield (
            "analysis/restored",
            entry_of({f"first {k}": v for k, v in first.items()} | dict(simulation.run(0.4, 0.01))),
        )
        planar = mbs.Simulation(mbs.compile(models.planar()))
        planar.run(0.2, 0.005)
        jump = planar.set_switch("hold", True)
        yield "analysis/switched", entry_of({"loss": jump} | dict(planar.run(0.4, 0.005)))
        for name in ("prototype", "hatchback"):
            rest = mbs.Simulation(mbs.compile(doors.car(name)), inputs={"selector": 0.0})
            rest.static_equilibrium()
            yield f"analysis/equilibrium/{name}", entry_of(_fields(rest.state))
            yield f"analysis/linear/{name}", entry_of(_modes(mbs.linearise(rest, side=1)), False)
        quarter = mbs.Simulation(mbs.compile(doors.example("quarter_car", "quarter_car")))
        quarter.static_equilibrium()
        yield "analysis/linear/quarter_car", entry_of(_modes(mbs.linearise(quarter)), False)
        bicycle = mbs.Simulation(mbs.compile(doors.scene("bicycle", lean_rate=0.0)))
        yield "analysis/linear/bicycle", entry_of(_modes(mbs.linearise(bicycle)), False)
        pendulum = mbs.Simulation(mbs.compile(doors.scene("pendulum")), settings=mbs.Settings(method="radau_5"))
        period = 4.0 * ellipk(0.5) / math.sqrt(9.81)  # from a quarter turn, rod of 1 m
        model = mbs.floquet(pendulum, period, period / 400.0)
        yield "analysis/floquet/pendulum", entry_of({"multipliers": np.sort(np.abs(model.multipliers))}, False)


def _fields(thing: Any) -> dict[str, Any]:
    """Numbers among the attributes of a record."""
    return {
        name: value
        for name, value in vars(thing).items()
        if isinstance(value, np.ndarray | float | int) or (isinstance(value, list | tuple) and _numbers(value))
    }


def _numbers(value: Any) -> bool:
    return bool(len(value)) and all(isinstance(x, float | int) for x in value)


def _modes(model: mbs.LinearModel) -> dict[str, Any]:
    """What does not depend on the scale of eigenvectors."""
    eigenvalues = np.sort_complex(np.linalg.eigvals(model.A))
    return {"real": eigenvalues.real, "imaginary": np.abs(eigenvalues.imag)}
