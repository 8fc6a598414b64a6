"""The parameter `fidelity` of an FMU: one table of variables, one System per fidelity."""

import json
from collections.abc import Callable
from pathlib import Path

import fmpy
import pytest
from fmpy import read_model_description
from fmpy.fmi1 import FMICallException

from fmu_src.build.build import build_fmu
from fmu_src.build.scene_registry import SceneError, load_fidelities
from fmu_src.variables.variables import check_fidelities
from hosts.common.errors import HostError
from hosts.fmu.fmu import Fmu
from mbs import Simulation, compile
from mbs.scenes import kerb_test
from mbs.scenes.prototype_car import Fidelity

OUTPUTS = ("stress.computed", "bending_moment.SG1", "stress.SG3", "chassis.x")
H = 0.01


@pytest.fixture
def kerb(kerb_fmus: Path) -> Path:
    return kerb_fmus / "native.fmu"


@pytest.fixture(scope="module")
def own(made_once: Callable[[str, Callable[[Path], None]], Path]) -> dict[int, list[list[float]]]:
    """Outputs of the engine by fidelity, at the start and after twenty steps."""

    def fill(folder: Path) -> None:
        rows = {}
        for fidelity in range(4):
            simulation = Simulation(compile(kerb_test.build(fidelity)))
            rows[fidelity] = [[simulation.sensors[name] for name in OUTPUTS]]
            simulation.step(H, 20)
            rows[fidelity].append([simulation.sensors[name] for name in OUTPUTS])
        (folder / "rows.json").write_text(json.dumps(rows))

    rows = json.loads((made_once("kerb_test_rows", fill) / "rows.json").read_text())
    return {int(fidelity): pair for fidelity, pair in rows.items()}


def values(fmu: Fmu, steps: int = 0, begin: int = 0) -> list[float]:
    for k in range(begin, begin + steps):
        fmu.step(k * H, H)
    return fmu.getter(OUTPUTS)()


def test_every_fidelity_is_the_system_of_the_scene(kerb: Path, own: dict[int, list[list[float]]]) -> None:
    """The rigid one has the stresses of the quasi-static one: all but the rounding of a car at rest."""
    rows = []
    for fidelity in range(4):
        with Fmu(kerb) as fmu:
            fmu.initialise({"fidelity": float(fidelity)})
            rows.append([values(fmu), values(fmu, 20)])
    assert rows[1:] == [own[1], own[2], own[3]]
    moved = OUTPUTS.index("chassis.x")
    for actual, rigid, ported in zip(rows[0], own[0], own[1], strict=True):
        assert actual[moved] == rigid[moved]
        assert actual == pytest.approx([*ported[:moved], rigid[moved]], rel=1e-9)


def test_other_values_are_refused(kerb: Path) -> None:
    for value, message in ((1.5, "whole number"), (4.0, "outside its range"), (-1.0, "outside")):
        with Fmu(kerb) as fmu, pytest.raises(HostError, match=f"fidelity.*{message}"):
            fmu.initialise({"fidelity": value})


def test_a_state_brings_its_fidelity_along(kerb: Path) -> None:
    with Fmu(kerb) as fmu, Fmu(kerb) as other:
        fmu.initialise({"fidelity": 1.0})
        values(fmu, 10)
        state = fmu._slave.getFMUState()
        saved = fmu._slave.serializeFMUState(state)
        fmu._slave.freeFMUState(state)
        other.initialise({"fidelity": 2.0})
        values(other, 3)
        copy = other._slave.deserializeFMUState(saved)
        other._slave.setFMUState(copy)
        other._slave.freeFMUState(copy)
        assert values(other, 10, begin=10) == values(fmu, 10, begin=10)


def test_the_fidelity_may_change_until_initialisation_ends(kerb: Path) -> None:
    with Fmu(kerb) as fmu, Fmu(kerb) as other:
        references = [scalar.reference for scalar in fmu.scalars(["fidelity"])]
        fmu._slave.setupExperiment(startTime=0.0)
        fmu._slave.enterInitializationMode()
        for fidelity in (2.0, 0.0, 1.0):
            fmu._slave.setReal(references, [fidelity])
            assert fmu.getter(("stress.SG3",))()[0] != 0.0
        fmu._slave.exitInitializationMode()
        other.initialise({"fidelity": 1.0})
        assert values(fmu, 5) == values(other, 5)
        with pytest.raises(FMICallException):
            fmu._slave.setReal(references, [2.0])


def test_a_reset_goes_back_to_the_default_of_the_scene(kerb: Path, own: dict[int, list[list[float]]]) -> None:
    with Fmu(kerb) as fmu:
        fmu.initialise({"fidelity": 0.0})
        values(fmu, 3)
        fmu._slave.reset()
        fmu.initialise({})
        assert [values(fmu), values(fmu, 20)] == own[Fidelity.DYNAMIC]


def logged(kerb: Path, fidelity: float | None, names: list[str], resets: int = 0) -> list[tuple[int, str, str]]:
    """Status, category and text of what an FMU logs while outputs are read at several times, as FMPy loads it."""
    messages: list[tuple[int, str, str]] = []

    class Heard(Fmu):
        def _log(self, status: int, category: str, message: str) -> None:
            messages.append((status, category, message))

    with Heard(kerb) as fmu:
        for run in range(resets + 1):
            if run:
                fmu.reset()
            fmu.initialise({} if fidelity is None else {"fidelity": fidelity})
            get = fmu.getter(names)
            for k in range(3):
                get()
                fmu.step(k * H, H)
            state = fmu.state()
            get()
            fmu.restore(state)
            fmu.free(state)
            get()
    return messages


def test_a_stress_causes_no_warning(kerb: Path) -> None:
    for fidelity in (0.0, 1.0, 3.0):
        assert logged(kerb, fidelity, list(OUTPUTS)) == []


def test_rates_of_round_off_of_a_car_that_stands_cause_no_warning(kerb: Path) -> None:
    messages: list[str] = []

    class Heard(Fmu):
        def _log(self, status: int, category: str, message: str) -> None:
            messages.append(message)

    for fidelity in (0.0, 1.0, 3.0):
        with Heard(kerb) as fmu:
            fmu.initialise({"fidelity": fidelity})
            values(fmu, 60)
    assert messages == []


@pytest.mark.slow
def test_an_output_that_no_system_computes_is_reported_once_a_run(tmp_path: Path) -> None:
    """The rigid car alone: there is no System with ports beside it."""
    alone = build_fmu(compile(kerb_test.build(0)), "alone", tmp_path, [fmpy.platform])
    ((status, category, text),) = logged(alone, None, ["chassis.x", "stress.SG3", "bending_moment.SG1"])
    assert (status, category) == (1, "logNotComputed")
    assert text == "'stress.SG3' reads 0; this FMU does not compute it. This is reported once."
    assert len(logged(alone, None, ["bending_moment.SG1"], resets=2)) == 3
    assert logged(alone, None, ["chassis.x", "energy.total"]) == []


def test_a_lost_file_is_named(kerb: Path) -> None:
    """A System that cannot be loaded leaves the instance as it was."""
    with Fmu(kerb) as fmu:
        fmu.load()
        lost = next(fmu._folder.glob("resources/**/system_2.ali3"))
        lost.unlink()
        with pytest.raises(HostError, match=r"system_2\.ali3.* cannot be read"):
            fmu.initialise({"fidelity": 2.0})
        fmu._slave.reset()
        fmu.initialise({"fidelity": 1.0})
        values(fmu, 2)


def test_fidelities_with_other_variables_are_refused() -> None:
    one = {"inputs": [], "parameters": [], "sensors": [{"name": "a", "unit": "m"}]}
    other = {"inputs": [], "parameters": [], "sensors": [{"name": "b", "unit": "m"}]}
    with pytest.raises(ValueError, match="Fidelity 1 has other sensors than fidelity 0, first 'b'"):
        check_fidelities([one, other])


def test_fidelities_are_numbered_from_zero(tmp_path: Path) -> None:
    file = tmp_path / "gap.py"
    file.write_text(
        "from mbs.scenes import pendulum\n"
        "def build(fidelity=0): return pendulum.build()\n"
        "def fidelities(): return {0: build, 2: build}\n"
    )
    with pytest.raises(SceneError, match=r"numbered \[0, 2\]"):
        load_fidelities(f"{file}:build")


def test_names_of_fidelities_stand_in_the_description(tmp_path: Path) -> None:
    file = tmp_path / "named.py"
    file.write_text(
        "from enum import IntEnum\n"
        "from mbs.scenes import pendulum\n"
        "class Level(IntEnum):\n    RIGID = 0\n    QUASI_STATIC = 1\n"
        "Level.RIGID.description = 'no stresses'\n"
        "def build(fidelity=Level.QUASI_STATIC): return pendulum.build()\n"
        "def fidelities(): return {k: build for k in reversed(Level)}\n"
    )
    name, systems, default = load_fidelities(f"{file}:build")
    assert (list(systems), default) == ([0, 1], 1)
    fmu = build_fmu(systems, name, tmp_path, [fmpy.platform], fidelity=default)
    (v,) = (v for v in read_model_description(str(fmu)).modelVariables if v.name == "fidelity")
    assert v.description == "Level of detail of the model: 0 rigid (no stresses), 1 quasi_static"
    assert (v.type, v.start, v.min, v.max) == ("Integer", "1", "0", "1")
