"""Each joint and each force in a free mechanism: none is left out, and energy stays where a method keeps it."""

from __future__ import annotations

import inspect

import pytest

import mbs
from benchmarks import work_precision
from benchmarks.methods.free_elements import ELEMENTS
from benchmarks.methods.free_runs import MECHANISMS, STEPS, TURNS, WRONG, measure
from mbs.elements import ElementType

KINDS = {"Joint", "Screw", "ElementRecord", "Armature", "Spin", "SlidingPoint", "Coordinate"}
OF_CARS = {"TYRE", "MAGIC_TYRE", "HUB_WRENCH", "AUTOMATIC_DRIVE", "ELECTRIC_DRIVE", "SPIN_ANGLE"}
"""Elements that only a car has: its balance of energy and work is tested as a whole; the last has no force."""


def test_each_joint_and_each_force_has_a_mechanism(monkeypatch):
    words = {
        name
        for name, method in inspect.getmembers(mbs.Model, inspect.isfunction)
        if method.__annotations__.get("return") in KINDS and not name.startswith("_")
    }
    used, types = set(), set()

    def noted(name, method):
        return lambda *given, **more: used.add(name) or method(*given, **more)

    for name in words:
        monkeypatch.setattr(mbs.Model, name, noted(name, getattr(mbs.Model, name)))
    for build in MECHANISMS.values():
        types |= {element.type.name for element in build(1.0).model.elements}
    assert words - used == {"joint_named"}
    assert {kind.name for kind in ElementType} - types == OF_CARS


def test_energy_momentum_keeps_the_energy_of_each():
    for name in ELEMENTS:
        found = measure(name, 0.2, 300, "energy_momentum")
        if name == "tabled body":
            assert found["told"] == "no"
        else:
            assert found["energy"] < (0.1 if name.startswith("drive") else 1e-4 if name == "friction" else 1e-8), found


def test_a_force_that_gives_energy_is_seen():
    """A spring without its energy: what the bodies have is not kept."""
    found = measure("spring, stops", 0.5, 500, "runge_kutta_8", told=True)
    assert found["energy"] > WRONG
    assert found["grows"]
    assert found["told"] == "AccuracyWarning"


def test_the_command_gives_the_tables(capsys):
    assert (
        work_precision.main(["free", "--quick", "--only", "weld", "rack", "skate", "--methods", "ali3p", "radau_5"])
        == 0
    )
    text = capsys.readouterr().out
    assert "| rack |" in text
    assert "| skate |" in text


@pytest.mark.slow
def test_what_grows_is_told_over_a_hundred_thousand_steps():
    """Bounded errors beyond `WRONG` are those of the page."""
    for name in MECHANISMS:
        for turn in TURNS:
            found = measure(name, turn, STEPS, told=True)
            assert found["energy"] is None or found["energy"] < WRONG or found["told"] or not found["grows"], found
