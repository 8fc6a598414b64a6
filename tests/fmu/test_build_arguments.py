"""`build_fmu` refuses wrong arguments in one sentence, before it writes anything."""

from pathlib import Path
from typing import Any

import pytest

import mbs
from ali3.errors import FileError
from fmu_src.build.arguments import systems_by_number
from fmu_src.build.build import build_fmu
from mbs.scenes import pendulum


@pytest.fixture(scope="module")
def system() -> mbs.System:
    return mbs.compile(pendulum.build())


def test_a_wrong_argument_is_named(system: mbs.System, tmp_path: Path) -> None:
    good: dict[str, Any] = {"system": system, "name": "swing", "out": tmp_path / "out", "platforms": ["linux64"]}
    for change, sentence in (
        ({"system": pendulum.build()}, "must be a System, which compile(model) makes, not Model 'pendulum'."),
        ({"system": {}}, "An FMU needs a System; none was given."),
        ({"system": {0: system, 2: system}}, "The Systems of an FMU are numbered [0, 2]; the numbers must be 0, 1, 2"),
        ({"system": {False: system}}, "are numbered [False]; the numbers must be 0, 1, 2 and on"),
        ({"name": None}, "The name of an FMU must be text, not None."),
        ({"name": "1a"}, "'1a' gives no name for an FMU"),
        ({"out": None}, "The folder of an FMU must be a path, not None."),
        ({"platforms": "linux64"}, "The platforms of an FMU must be a list of names, not 'linux64'."),
        ({"platforms": []}, "An FMU needs a platform; a native FMU runs on linux64"),
        ({"platforms": ["amiga", 3]}, "Platform '3, amiga' is not known; a native FMU runs on linux64"),
        ({"kind": ["native"]}, "There is no FMU kind"),
        ({"fidelity": 1}, "The default fidelity of an FMU is 1; it must be 0."),
        ({"fidelity": "0"}, "The default fidelity of an FMU is '0'; it must be 0."),
        ({"author": 3}, "The author must be text, not 3."),
    ):
        with pytest.raises(ValueError) as caught:  # noqa: PT011  compared as text below
            build_fmu(**good | change)
        assert sentence in str(caught.value)
        assert str(caught.value).count("\n") == 0
    assert not (tmp_path / "out").exists()


def test_systems_stand_in_the_order_of_their_numbers(system: mbs.System) -> None:
    other = mbs.compile(pendulum.build(length=2.0))
    assert list(systems_by_number({1: other, 0: system}).values()) == [system, other]
    assert systems_by_number([system, other]) == {0: system, 1: other}


def test_a_name_too_long_for_a_file_is_reported_before_the_work(system: mbs.System, tmp_path: Path) -> None:
    with pytest.raises(FileError, match="cannot be written: file name too long"):
        build_fmu(system, "x" * 300, tmp_path, ["linux64"])
    assert list(tmp_path.iterdir()) == []
