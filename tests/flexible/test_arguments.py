"""Every argument of what makes and reduces a flexible body, given wrong values: each is refused in a sentence."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

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
from tests.flexible_engine.bodies import bar
from tests.wrong_values import arguments_of, as_scalars, problems_of

STEEL, ROD = Material(2.1e11, 0.3, 7850.0), round_bar(0.02)
NODES = np.array([[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [1.0, 0.0, 0.0]])
FRAME = Frame(NODES, [Beam(0, 1, ROD, STEEL), Beam(1, 2, ROD, STEEL)])
MODEL = FRAME.finite_element_model()
ROWS = section_forces(FRAME, 0, 0.5)

CALLS: dict[str, tuple[Callable[..., Any], dict[str, Any]]] = {
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


def call(name: str, /, **changed: Any) -> Any:
    function, kwargs = CALLS[name]
    rows = {"rows": ROWS} if name in ("inertia_relief", "modes_for_output") else {}
    return function(**(kwargs | rows | changed))


def allowed(name: str, argument: str, kind: str, label: str, value: Any) -> bool:
    """Whether a value is right for an argument after all."""
    if value is None:
        return "None" in kind
    if label == "True":
        return kind.startswith("bool")
    return (argument, label) in {
        ("masses", "a mapping"),
        ("reference", "text"),
        ("which", "text"),
        ("names", "a list of text"),
    }


@pytest.mark.parametrize("name", CALLS)
def test_wrong_values_are_refused(name):
    call(name)
    problems = []
    for parameter in arguments_of(CALLS[name][0]):
        if parameter.name not in CALLS[name][1]:
            continue
        problems += problems_of(
            lambda value, p=parameter: call(name, **{p.name: value}),
            parameter.name,
            lambda label, value, p=parameter: allowed(name, p.name, str(p.annotation), label, value),
        )
    assert not problems, "\n".join(problems)


@pytest.mark.parametrize("name", CALLS)
def test_numbers_of_numpy_are_numbers(name):
    for argument, value in CALLS[name][1].items():
        for same in as_scalars(value):
            call(name, **{argument: same})
