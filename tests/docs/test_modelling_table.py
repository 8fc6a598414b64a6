"""The table of joints in docs/modelling.md: equations and freedoms as the vocabulary writes them."""

import re
from pathlib import Path

from mbs import Model, compile

PAGE = Path(__file__).parents[2] / "docs" / "modelling.md"
FREE = {2: 6, 3: 12}  # of two rigid bodies
ROW = re.compile(r"\| `(\w+)` \| (-|\d+ \+ \d+) \| (-|\d+) \| (-|\d+ \+ \d+) \| (-|\d+) \|")
CASES = [
    (match[1], dimension, match[column], match[column + 1])
    for match in ROW.finditer(PAGE.read_text(encoding="utf-8"))
    for dimension, column in ((2, 2), (3, 4))
    if match[column] != "-"
]


def two_bodies_with(kind, dimension):
    m = Model("pair", dimension=dimension)
    com_1, com_2, at = (0.1, 0.2, 0.3)[:dimension], (0.9, -0.3, 0.6)[:dimension], (0.5, 0.1, -0.2)[:dimension]
    inertia = 0.2 if dimension == 2 else (0.2, 0.3, 0.25)
    a, b = m.body("a", mass=1.0, com=com_1, inertia=inertia), m.body("b", mass=2.0, com=com_2, inertia=inertia)
    axis = (1.0, 2.0, 0.5)[:dimension]
    if kind == "universal":
        return m, m.universal("j", a, b, point=at, axis_1=(1, 0, 0), axis_2=(0, 1, 0.3))
    if kind in ("distance", "point_on_line"):
        extra = {"axis": axis} if kind == "point_on_line" else {}
        other = at if kind == "point_on_line" else com_2
        return m, getattr(m, kind)("j", (a, at), (b, other), **extra)
    if kind == "weld":
        return m, m.weld("j", a, b)
    turns = kind in ("prismatic", "cylindrical") or (kind == "revolute" and dimension == 3)
    return m, getattr(m, kind)("j", a, b, point=at, **({"axis": axis} if turns else {}))


def test_joints_write_the_equations_of_the_page():
    assert len(CASES) == 14
    for kind, dimension, equations, freedoms in CASES:
        m, joint = two_bodies_with(kind, dimension)
        linear = sum(e.is_linear for e in joint.equations)
        assert f"{linear} + {len(joint.equations) - linear}" == equations, kind
        assert compile(m).report["degrees_of_freedom"] == FREE[dimension] - int(freedoms), kind
