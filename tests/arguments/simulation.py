"""Every argument of what compiles, steps and looks at a System."""

import dataclasses
import math
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from mbs import Model, Pose, Settings, Simulation, System, Trajectory, compile, floquet, linearise, simulate
from tests.arguments.wrong_values import Call, kinds_of


@cache
def pushed() -> System:
    """A mass on a spring, pushed by an input and held by a switch."""
    m = Model("pushed", dimension=2, gravity=(0.0, 0.0))
    mass = m.body("mass", mass=1.0, com=(1.0, 0.0), inertia=0.1)
    m.prismatic("slide", m.ground, mass, axis=(1.0, 0.0))
    spring = m.spring_damper("spring", (m.ground, (0.0, 0.0)), (mass, (1.0, 0.0)), stiffness=100.0)
    push = m.input("push", min=-10.0, max=10.0, unit="N")
    m.force("pushed", mass, inputs=[push, None])
    m.parameter("spring.stiffness", 100.0, 10.0, 1000.0, "N/m", targets=[(spring, "stiffness", 1.0)])
    m.pin("hold", mass)
    m.sense_position("x", mass)
    return compile(m)


@cache
def thrown() -> System:
    """A body that flies."""
    m = Model("thrown", gravity=(0.0, 0.0, 0.0))
    m.body("stone", mass=1.0, com=(0.0, 0.0, 0.0), inertia=(1.0, 1.0, 1.0))
    m.floating = True
    return compile(m)


def a_model() -> Model:
    m = Model("stone")
    m.body("stone", mass=1.0, com=(0.0, 0.0, 0.0), inertia=(1.0, 1.0, 1.0))
    return m


START = {"settings": Settings(), "inputs": {"push": 1.0}, "parameters": {"spring.stiffness": 50.0}, "t0": 0.5}
TRACE = Trajectory(np.array([0.0, 1.0]), np.ones((2, 1)), ["x"], ["m"])


def running() -> Simulation:
    return Simulation(pushed())


RIGHT: dict[str, tuple[Callable[[], Callable[..., Any]], dict[str, Any]]] = {
    "compile": (lambda: compile, {"model": a_model(), "tolerance": 1e-3}),
    "Simulation": (lambda: Simulation, {"system": pushed(), **START}),
    "Simulation with a pose": (lambda: Simulation, {"system": thrown(), "pose": Pose(1.0)}),
    "simulate": (
        lambda: simulate,
        {
            "system": pushed(),
            "t_end": 1.0,
            "h": 0.1,
            **START,
            "every": 2,
            "progress": False,
            "method": "ali3p",
            "estimate_error": False,
        },
    ),
    "simulate to a tolerance": (
        lambda: simulate,
        {"system": pushed(), "t_end": 1.0, "tolerance": 1e-2, "times": [0.5, 1.0]},
    ),
    "set_input": (lambda: running().set_input, {"name": "push", "value": 1.0}),
    "set_parameter": (lambda: running().set_parameter, {"name": "spring.stiffness", "value": 50.0}),
    "set_switch": (lambda: running().set_switch, {"name": "hold", "on": True}),
    "switch": (lambda: running().switch, {"name": "hold"}),
    "static_equilibrium": (lambda: running().static_equilibrium, {"tolerance": 1e-3, "max_iterations": 10}),
    "step": (lambda: running().step, {"h": 0.01, "n": 2}),
    "run": (
        lambda: running().run,
        {"t_end": 1.0, "h": 0.1, "inputs": {"push": 1.0}, "every": 2, "progress": False, "estimate_error": False},
    ),
    "run to a tolerance": (lambda: running().run, {"t_end": 1.0, "tolerance": 1e-2}),
    "change_settings": (lambda: running().change_settings, {"settings": Settings()}),
    "restore": (lambda: running().restore, {"state": running().save()}),
    "linearise": (lambda: linearise, {"simulation": running(), "side": 1}),
    "floquet": (lambda: floquet, {"simulation": running(), "period": 2.0 * math.pi / 10.0, "h": 0.01}),
    "Pose": (lambda: Pose, {"x": 1.0, "y": 1.0, "z": 1.0, "yaw": 1.0, "speed": 1.0}),
    "Settings": (lambda: Settings, dataclasses.asdict(Settings())),
    "Trajectory[...]": (lambda: TRACE.__getitem__, {"name": "x"}),
    "thinned": (lambda: TRACE.thinned, {"every": 2}),
    "from_bytes": (lambda: System.from_bytes, {"data": pushed().to_bytes()}),
}


def allowed(call: str, argument: str, label: str, value: Any) -> bool:
    """Whether a value is right for an argument after all."""
    if label == "a mapping":
        return argument in ("inputs", "parameters")
    if call == "Pose" and label == "1e300":
        return argument != "yaw"  # the kernel says which starts are too far and too fast
    return label == "a function" and argument == "progress"


def call_of(call: str) -> Call:
    """The call of an entry of `RIGHT`."""
    make, right = RIGHT[call]
    kinds = kinds_of(make(), right)
    needed = {"run": "h", "run to a tolerance": "tolerance"}.get(call)  # None is right for one of the two
    if needed:
        kinds[needed] = kinds[needed].replace("None", "")
    return Call(
        lambda: (make(), right), kinds, lambda argument, label, value: allowed(call, argument, label, value), state_of
    )


def state_of(function: Any) -> bytes:
    """The state of the simulation that a call may change."""
    owner = getattr(function, "__self__", None)
    return owner.save() if isinstance(owner, Simulation) else b""


CALLS = {call: call_of(call) for call in RIGHT}
