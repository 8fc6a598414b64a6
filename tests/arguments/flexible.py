"""Every argument of what makes and reduces a flexible body."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from mbs.flexible import (
    Beam,
    Frame,
    Material,
    RayleighDamping,
    craig_bampton,
    inertia_relief,
    modes_for_output,
    natural_modes,
    rectangle,
    round_bar,
    section_forces,
    tube,
)
from tests.arguments.wrong_values import Call, kinds_of
from tests.flexible_engine.bodies import bar

STEEL, ROD = Material(2.1e11, 0.3, 7850.0), round_bar(0.02)
NODES = np.array([[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [1.0, 0.0, 0.0]])
FRAME = Frame(NODES, [Beam(0, 1, ROD, STEEL), Beam(1, 2, ROD, STEEL)])
MODEL = FRAME.finite_element_model()
ROWS = section_forces(FRAME, 0, 0.5)

RIGHT: dict[str, tuple[Callable[..., Any], dict[str, Any]]] = {
    "Material": (Material, {"E": 2.1e11, "nu": 0.3, "rho": 7850.0}),
    "tube": (tube, {"outer_diameter": 0.02, "wall": 0.002}),
    "round_bar": (round_bar, {"diameter": 0.02}),
    "rectangle": (rectangle, {"width": 0.02, "height": 0.01}),
    "Frame": (
        Frame,
        {
            "positions": NODES,
            "beams": [Beam(0, 1, ROD, STEEL)],
            "masses": [0.0, 1.0, 0.0],
            "names": ["a", "b", "c"],
            "theory": "timoshenko",
        },
    ),
    "finite_element_model": (FRAME.finite_element_model, {"mass": "lumped", "rotary": True}),
    "element_axes": (FRAME.element_axes, {"element": 1}),
    "node": (MODEL.node, {"which": 1}),
    "freedoms": (MODEL.freedoms, {"which": 1, "rotations": True}),
    "craig_bampton": (
        craig_bampton,
        {
            "model": MODEL,
            "reference": 0,
            "interfaces": [2],
            "dynamic_modes": 2,
            "inertia_modes": False,
            "damping": RayleighDamping(1.0, 1e-5),
        },
    ),
    "craig_bampton up to": (craig_bampton, {"model": MODEL, "reference": 0, "interfaces": [2], "up_to": 500.0}),
    "natural_modes": (natural_modes, {"model": MODEL, "count": 8}),
    "inertia_relief": (inertia_relief, {"model": MODEL, "reference": 0, "interfaces": [2]}),
    "modes_for_output": (
        modes_for_output,
        {"model": MODEL, "reference": 0, "interfaces": [2], "tolerance": 0.5, "candidates": 5, "inertia_modes": True},
    ),
    "fitted": (RayleighDamping.fitted, {"ratio": 0.02, "low": 1.0, "high": 100.0}),
    "section_forces": (section_forces, {"frame": FRAME, "element": 1, "xi": 0.5}),
    "interface": (bar((0, 0, 0), (1, 0, 0)).interface, {"name": "8"}),
}


def allowed(argument: str, label: str, value: Any) -> bool:
    """Whether a value is right for an argument after all."""
    return (argument, label) in {
        ("masses", "a mapping"),
        ("reference", "text"),
        ("which", "text"),
        ("names", "a list of text"),
    }


def call_of(function: Callable[..., Any], right: dict[str, Any]) -> Call:
    """A function and the arguments that are tried; section forces are those of the frame."""
    bound = partial(function, rows=ROWS) if function in (inertia_relief, modes_for_output) else function
    return Call(lambda: (bound, right), kinds_of(function, right), allowed)


CALLS = {name: call_of(*use) for name, use in RIGHT.items()}
