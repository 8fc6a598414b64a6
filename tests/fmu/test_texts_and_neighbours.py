"""Texts of users: those that XML cannot hold are refused; scenes import the files beside them."""

import sys
from pathlib import Path

import pytest

import mbs
from fmu_src.build.build import build_fmu
from fmu_src.build.scene_registry import SceneError, load_scene
from fmu_src.variables.texts import check_texts
from fmu_src.variables.variables import Variable

SCENE = """
import mbs
import lengths

def swing():
    import sched
    assert hasattr(sched, "scheduler"), "sched.py of the user"
    m = mbs.Model("swing", dimension=2)
    bob = m.point_mass("bob", mass=1.0, position=(lengths.LENGTH, 0.0))
    m.distance("rod", (m.ground, (0.0, 0.0)), bob)
    m.sense_position("bob.x", bob, component="x")
    return m

def late():
    import hosts
    assert hosts.MINE
    return swing()

def slip():
    return mbs.Model("swing", dimension=2).nothing

def refused():
    return mbs.Model("swing", dimension=4)

def value():
    return int("four")
"""


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    (tmp_path / "scene.py").write_text(SCENE)
    (tmp_path / "lengths.py").write_text("LENGTH = 1.25\n")
    (tmp_path / "hosts.py").write_text("MINE = True\n")
    for name in ("mbs", "fmu_src", "numpy", "sched", "build_fmu", "ali3"):
        (tmp_path / f"{name}.py").write_text("raise SystemExit('a file of the user')\n")
    return tmp_path / "scene.py"


@pytest.fixture(autouse=True)
def _clean(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("hosts", "lengths", "sched"):
        monkeypatch.delitem(sys.modules, name, raising=False)


@pytest.mark.parametrize("function", ["swing", "late"])
def test_a_scene_imports_the_files_beside_it(scene: Path, function: str, monkeypatch: pytest.MonkeyPatch) -> None:
    before = list(sys.path), list(sys.meta_path)
    with monkeypatch.context() as patch:
        for name in [n for n in sys.modules if n.partition(".")[0] == "hosts"]:
            patch.delitem(sys.modules, name)
        name, system = load_scene(f"{scene}:{function}")
        sys.modules.pop("hosts", None)
        sys.modules.pop("lengths", None)
    assert name == function
    assert mbs.simulate(system, 0.01, 0.01)["bob.x"][0] == 1.25
    assert (sys.path, sys.meta_path) == before


@pytest.mark.parametrize(
    ("function", "message"),
    [
        ("slip", r"scene\.py, line \d+: AttributeError: .*nothing"),
        ("value", r"scene\.py, line \d+: ValueError: invalid literal"),
        ("refused", r"^The dimension of model 'swing' is 4"),
    ],
)
def test_errors_of_a_scene_have_their_place(scene: Path, function: str, message: str) -> None:
    with pytest.raises(ValueError, match=message) as error:
        load_scene(f"{scene}:{function}")
    assert isinstance(error.value, SceneError) == (function != "refused")
    scene.write_text("def swing(:\n")
    with pytest.raises(SceneError, match=r"scene\.py, line 1: invalid syntax"):
        load_scene(f"{scene}:swing")
    scene.write_text("import not_there\n")
    with pytest.raises(SceneError, match=r"scene\.py, line 1: ModuleNotFoundError: No module named 'not_there'"):
        load_scene(f"{scene}:swing")


def test_characters_that_xml_cannot_hold_are_refused(tmp_path: Path) -> None:
    m = mbs.Model("swing", dimension=2)
    bob = m.point_mass("bob", mass=1.0, position=(1.0, 0.0))
    m.distance("rod", (m.ground, (0.0, 0.0)), bob)
    system = mbs.compile(m)
    for text in ("a\x01b", "a\x00b", "a\ud800b", "a\ufffeb"):
        with pytest.raises(ValueError, match=rf"author has the character U\+{ord(text[1]):04X} at place 2"):
            build_fmu(system, "swing", tmp_path / "out", ["linux64"], author=text)
        with pytest.raises(ValueError, match=r"description of the model has the character U\+"):
            build_fmu(system, f"swing {text}", tmp_path / "out", ["linux64"])
    assert not (tmp_path / "out").exists()


def test_a_text_of_a_variable_is_named() -> None:
    table = [
        Variable(name, "output", "continuous", "m", text, "sensor", k)
        for k, (name, text) in enumerate((("bob.x", "good\n\tµ"), ("bob.y", "bell \x07")))
    ]
    check_texts("model", ("", "", ""), table[:1])
    with pytest.raises(ValueError, match=r"description of 'bob\.y' has the character U\+0007 at place 6"):
        check_texts("model", ("", "", ""), table)
    with pytest.raises(ValueError, match=r"name 'bob\\ufffe' has the character U\+FFFE at place 4"):
        check_texts("model", ("", "", ""), [Variable("bob\ufffe", "output", "continuous", "m", "", "sensor", 0)])
