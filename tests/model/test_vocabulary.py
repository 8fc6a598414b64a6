"""A joint is said once, by the function that makes it: help and type checkers show it as a method of the model."""

import inspect
import pydoc
import re
from pathlib import Path

import pytest

from mbs import Model
from mbs.model.angle import relative_angle
from mbs.model.anti_roll_bar import anti_roll_bar
from mbs.model.joint_vocabulary import JointVocabulary
from tests.house.test_import_directions import ROOT

WORDS = {name: function for name, function in vars(JointVocabulary).items() if not name.startswith("_")}

TYPES = """
from mbs import Model
from mbs.model import Coordinate, Joint
from mbs.model.joints.screw import Screw
m = Model("typed")
a = m.body("a", mass=1.0, com=(0.0, 0.0, 0.0), inertia=(1.0, 1.0, 1.0))
good_1: Joint = m.revolute("pin", m.ground, a, point=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0))
good_2: Screw = m.screw("screw", m.ground, a, point=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0), pitch=0.1)
good_3: Coordinate = m.relative_angle("angle", m.ground, a, axis=(0.0, 0.0, 1.0))
m.revolute("pin", m.ground, a)  # missing
m.revolute("pin", m.ground, a, (0.0, 0.0, 0.0))  # by position
m.gear("gear", good_3, good_3, ratio="two")  # no number
bad: str = m.weld("weld", m.ground, a)  # another class
"""


def test_a_joint_is_added_by_the_method_and_not_by_the_function() -> None:
    m = Model("plane", dimension=2)
    rod = m.body("rod", mass=1.0, com=(0.5, 0.0), inertia=0.1)
    result = inspect.unwrap(JointVocabulary.revolute)(m, "other", m.ground, rod, point=(0.0, 0.0))
    assert result.name == "other"
    assert m.joints == []
    joint = m.revolute("pin", m.ground, rod, point=(0.0, 0.0))
    assert m.joints == [joint]
    assert relative_angle is inspect.unwrap(Model.relative_angle)
    assert anti_roll_bar is inspect.unwrap(Model.anti_roll_bar)


def test_help_shows_the_functions_as_methods() -> None:
    for name, made in WORDS.items():
        function = inspect.unwrap(made)
        shown = pydoc.plain(pydoc.render_doc(getattr(Model("plane", dimension=2), name)))
        model, *parameters = inspect.signature(function).parameters
        assert model == "model", name
        assert re.search(rf"^{name}\({parameters[0]}: ", shown, re.MULTILINE)
        assert all(f"{parameter}: " in shown for parameter in parameters)
        assert "model: " not in shown
        assert getattr(Model, name).__doc__ is function.__doc__


@pytest.mark.proof
def test_type_checkers_know_the_arguments_and_the_result(tmp_path: Path) -> None:
    api = pytest.importorskip("mypy.api")
    script = tmp_path / "typed.py"
    script.write_text(TYPES, encoding="utf-8")
    output, _, _ = api.run([str(script), "--config-file", str(ROOT / "pyproject.toml")])
    matches = re.findall(r"typed\.py:(\d+): error: .*\[([\w-]+)\]", output)
    lines = TYPES.splitlines()
    assert {lines[int(n) - 1].split("# ")[-1]: code for n, code in matches} == {
        "missing": "call-arg",
        "by position": "call-arg",
        "no number": "arg-type",
        "another class": "assignment",
    }
