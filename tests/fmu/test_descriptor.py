"""The model description: valid for two checkers, complete, and the same from two builds."""

import math
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import fmpy
import pytest
from fmpy.validation import validate_fmu

from fmu_src.build.build import build_fmu
from fmu_src.build.scene_registry import load_scene
from fmu_src.variables.units import DISPLAY_UNITS, parse_unit
from fmu_src.variables.variables import variable_table
from tests import kinds

SCENES = Path(__file__).parent / "scenes.py"
ONE = {
    ("rad", "deg"): math.pi / 180.0,
    ("rad/s", "deg/s"): math.pi / 180.0,
    ("rad/s", "rpm"): 2.0 * math.pi / 60.0,
    ("rad/s2", "deg/s2"): math.pi / 180.0,
    ("m/s", "km/h"): 1000.0 / 3600.0,
    ("Pa", "MPa"): 1e6,
}
"""One display unit in its unit."""
META = {"inputs": [], "parameters": [], "sensors": [{"name": "a.x", "unit": "m", "description": ""}]}


@pytest.mark.parametrize(("scene", "kind"), [("sled", "native"), ("crane", "fmi3"), ("reach", "python")])
def test_fmpy_finds_nothing(build: Callable[..., Path], scene: str, kind: str) -> None:
    assert validate_fmu(str(build(scene, kind))) == []


@pytest.mark.slow
@pytest.mark.parametrize(("scene", "kind"), [("sled", "native"), ("crane", "python")])
def test_fmu_manipulation_toolbox_finds_nothing(build: Callable[..., Path], scene: str, kind: str) -> None:
    pytest.importorskip("fmu_manipulation_toolbox")
    code = "from fmu_manipulation_toolbox.cli.fmutool import fmutool; fmutool()"
    done = subprocess.run(
        [sys.executable, "-c", code, "-input", str(build(scene, kind)), "-check"],
        capture_output=True,
        text=True,
        check=True,
    )
    output = done.stdout + done.stderr
    assert "compliant with FMI-2.0" in output
    assert "No semantic error" in output
    assert "ERROR" not in output
    assert "WARNING" not in output


@pytest.mark.parametrize("kind", ["fmi3", "python"])
def test_two_builds_give_the_same_bytes(build: Callable[..., Path], tmp_path: Path, kind: str) -> None:
    name, system = load_scene(f"{SCENES}:crane")
    again = build_fmu(system, name, tmp_path, [fmpy.platform], kind=kind)
    assert again.read_bytes() == build("crane", kind).read_bytes()


@pytest.mark.parametrize("kind", kinds.FMI_2)
def test_flags_and_experiment(build: Callable[..., Path], kind: str) -> None:
    description = fmpy.read_model_description(str(build("crane", kind)))
    face = description.coSimulation
    assert face.canGetAndSetFMUstate
    assert face.canSerializeFMUstate
    assert face.canHandleVariableCommunicationStepSize
    assert face.canInterpolateInputs
    assert face.providesDirectionalDerivative
    assert face.canNotUseMemoryManagementFunctions == (kind == "python")
    assert face.needsExecutionTool == (kind == "python")
    assert description.variableNamingConvention == "structured"
    assert float(description.defaultExperiment.stepSize) == 0.01


def test_variables_carry_units_and_descriptions_of_the_scene(build: Callable[..., Path]) -> None:
    variables = {v.name: v for v in fmpy.read_model_description(str(build("crane"))).modelVariables}
    torque = variables["torque"]
    assert (torque.causality, torque.unit, torque.min, torque.max, float(torque.start)) == (
        "input",
        "N.m",
        "-30.0",
        "30.0",
        0.0,
    )
    assert torque.description == "Torque of the motor in the hinge"
    assert variables["spring.stiffness"].variability == "tunable"
    assert variables["step_size"].variability == "fixed"
    assert variables["rod.angle"].displayUnit == "deg"
    assert "initial.x" not in variables


def reached(unknowns: list[Any]) -> dict[str, set[str]]:
    return {u.variable.name: {v.name for v in u.dependencies} for u in unknowns}


def test_dependencies_are_those_that_can_be_seen(build: Callable[..., Path]) -> None:
    description = fmpy.read_model_description(str(build("crane")))
    outputs = {v.name for v in description.modelVariables if v.causality == "output"}
    step, initial = reached(description.outputs), reached(description.initialUnknowns)
    assert set(step) == set(initial) == outputs
    # what is set reaches nothing before the next step
    assert not any(step.values())
    # the drawn position is the initial one, whatever is set; only accelerations follow the torque and the spring
    assert initial["rod.x"] == initial["rod.angle"] == set()
    assert initial["rod.ay"] == {"torque", "spring.stiffness"}
    assert initial["torque_used"] == {"torque"}
    assert initial["solver.energy_error"] == set()


def test_units_in_base_units() -> None:
    for unit, exponents in (
        ("m/s2", {"m": 1, "s": -2}),
        ("N.m/rad", {"kg": 1, "m": 2, "s": -2, "rad": -1}),
        ("N m", {"kg": 1, "m": 2, "s": -2}),
        ("kg m^2", {"kg": 1, "m": 2}),
        ("1", {}),
    ):
        parsed = parse_unit(unit)
        assert parsed.exponents == exponents
        assert parsed.factor == 1.0
    assert parse_unit("km/h", foreign=True).factor == pytest.approx(1.0 / 3.6)
    assert parse_unit("g", foreign=True).exponents == parse_unit("m/s2").exponents


def test_unknown_units_and_names_that_fmi_does_not_allow_are_refused() -> None:
    """Grams are no gravity, and a height no hour."""
    for name, unit, message in (
        *(("a.x", unit, rf"'a\.x'.*'{unit}'.*known symbols") for unit in ("furlong", "g", "h")),
        *((name, "m", "cannot be the name") for name in ("1x", "a..b", "ä", "a[b]")),
    ):
        with pytest.raises(ValueError, match=message):
            variable_table(META | {"sensors": [{"name": name, "unit": unit}]}, pose=False, step_size=0.01)


def test_a_display_unit_is_so_much_of_its_unit() -> None:
    actual = {(unit, shown): part for unit, units in DISPLAY_UNITS.items() for shown, part in units.items()}
    assert actual == pytest.approx({names: 1.0 / size for names, size in ONE.items()}, rel=1e-15)


def test_what_no_name_in_fmi_has_is_an_underscore_and_names_stay_distinct() -> None:
    names = ("angle.1", "arm.2.x", "wheel_1.x1", "rear wheel.spin", "cart-pole.x[2]")
    sensors = [{"name": name, "unit": "rad"} for name in names]
    table = variable_table(META | {"sensors": sensors}, pose=False, step_size=0.01)
    named = ["rear_wheel.spin", "cart_pole.x[2]"]
    assert [v.name for v in table if v.source == "sensor"] == ["angle_1", "arm_2.x", "wheel_1.x1", *named]
    twice = [{"name": name, "unit": "rad"} for name in ("angle.1", "angle_1")]
    with pytest.raises(ValueError, match="Two variables are named 'angle_1'"):
        variable_table(META | {"sensors": twice}, pose=False, step_size=0.01)
