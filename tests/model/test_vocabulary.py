"""A joint is said once, by the function that makes it: help, type checkers and the reference page show it as a method
of the model.
"""

import inspect
import pydoc
import re
import shutil
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


@pytest.mark.parametrize("name", WORDS)
def test_help_shows_the_function_as_the_method(name: str) -> None:
    method, function = getattr(Model, name), inspect.unwrap(WORDS[name])
    assert function.__module__.startswith(("mbs.model.joints.", "mbs.model.angle", "mbs.model.anti_roll_bar"))
    shown = pydoc.plain(pydoc.render_doc(getattr(Model("plane", dimension=2), name)))
    parameters = list(inspect.signature(function).parameters)
    assert parameters[0] == "model"
    assert re.search(rf"^{name}\({parameters[1]}: ", shown, re.MULTILINE)
    assert all(f"{parameter}: " in shown for parameter in parameters[1:])
    assert "model: " not in shown
    for line in inspect.cleandoc(function.__doc__ or "").splitlines():
        assert line in shown
    assert method.__doc__ is function.__doc__


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


@pytest.mark.slow
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


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:The mapping interface for autodoc options")
def test_the_reference_page_has_each_with_its_arguments(tmp_path: Path) -> None:
    application = pytest.importorskip("sphinx.application")
    shutil.copy(ROOT / "docs" / "reference" / "model.rst", tmp_path / "index.rst")
    options = {
        "extensions": ["sphinx.ext.autodoc", "sphinx.ext.napoleon"],
        "autodoc_default_options": {"members": True, "inherited-members": "int,Exception,Mapping"},
        "napoleon_google_docstring": False,
    }
    out = tmp_path / "out"
    built = application.Sphinx(
        tmp_path, None, out, tmp_path / "trees", "text", confoverrides=options, status=None, warning=None
    )
    built.build()
    page = (out / "index.txt").read_text(encoding="utf-8")
    for name, method in WORDS.items():
        function = inspect.unwrap(method)
        entry = page.split(f"\n   {name}(", 1)[1].split("\n\n   ", 1)
        flat = " ".join(entry[0].split())
        assert all(re.search(rf"\b{p}\b", flat) for p in list(inspect.signature(function).parameters)[1:])
        first = inspect.cleandoc(function.__doc__ or "").split("\n\n")[0].split("`")[0]
        assert " ".join(first.split())[:60] in " ".join(entry[1].split())[:200]
