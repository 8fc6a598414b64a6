"""FMUs under the names and units of other programs: the numbers are those of our names, converted."""

import importlib.util
import math
import zipfile
from pathlib import Path

import fmpy
import numpy as np
import pytest

from ali3.alias_file import read_content
from ali3.errors import UserError
from fmu_src.build.build import build_fmu
from fmu_src.build.scene_registry import load_scene
from fmu_src.variables.renamed_variables import renamed
from fmu_src.variables.variables import variable_table
from tests.fmu.other_hosts import by_c_host, by_libcosim

SCENES = Path(__file__).parent / "scenes.py"
NAMES = """
torque = { name = "Motor.Trq", factor = -1e-3, unit = "N.m" }
"rod.angle" = { name = "Rod[1].Angle", unit = "deg" }
"rod.x" = { name = "X", unit = "mm" }
"spring.stiffness" = "C_Spring"
"rod.ay" = { from = "rate(rod.x)" }
"""
DEGREES = 180.0 / math.pi


def named(folder: Path, text: str = NAMES, kind: str = "native") -> Path:
    (folder / "names.toml").write_text(text, encoding="utf-8")
    name, system = load_scene(f"{SCENES}:crane")
    return build_fmu(system, name, folder, [fmpy.platform], kind=kind, names=read_content(folder / "names.toml"))


@pytest.fixture(scope="module")
def renamed_crane(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The crane with another sign of the torque, in kN m, degrees and millimetres."""
    return named(tmp_path_factory.mktemp("named"))


def test_values_rates_and_derivatives_are_ours_converted(host, build, renamed_crane) -> None:
    ours = host(build("crane")).start({"torque": 2.0, "spring.stiffness": 6.0})
    theirs = host(renamed_crane).start({"Motor.Trq": -2e-3, "C_Spring": 6.0})
    one, other = ours.references, theirs.references
    for k in range(20):
        ours.slave.setRealInputDerivatives([one["torque"]], [1], [30.0])
        theirs.slave.setRealInputDerivatives([other["Motor.Trq"]], [1], [-30e-3])
        assert ours.step(0.01 * k, 0.01) == theirs.step(0.01 * k, 0.01) == 0
    x, angle = ours.get("rod.x"), ours.get("rod.angle")
    assert abs(angle) > 0.05
    assert theirs.get("X") == pytest.approx(1e3 * x, rel=1e-12)
    assert theirs.get("Rod[1].Angle") == pytest.approx(DEGREES * angle, rel=1e-12)
    assert theirs.get("rod.ay") == pytest.approx(ours.get("rod.ay"), rel=1e-9)
    rate, present = (
        h.slave.getRealOutputDerivatives([r], [1])[0]
        for h, r in ((ours, one["rod.angle"]), (theirs, other["Rod[1].Angle"]))
    )
    assert present == pytest.approx(DEGREES * rate, rel=1e-9)
    slope = ours.slave.getDirectionalDerivative([one["rod.x"]], [one["torque"]], [1.0])[0]
    present = theirs.slave.getDirectionalDerivative([other["X"]], [other["Motor.Trq"]], [1.0])[0]
    assert present == pytest.approx(1e3 * slope / -1e-3, rel=1e-6)
    # the end of the range is the other one
    assert theirs.set("Motor.Trq", -0.5) == 0
    assert "'Motor.Trq' was set to -0.5 N.m and is held at -0.03" in theirs.messages[-1]
    state = theirs.saved()
    theirs.step(0.2, 0.01)
    after = theirs.get("X")
    assert theirs.restore(bytes(state)) == 0
    theirs.step(0.2, 0.01)
    assert theirs.get("X") == after


def test_description_and_results_have_the_other_names_and_units(renamed_crane) -> None:
    description = fmpy.read_model_description(str(renamed_crane), validate=True)
    variables = {v.name: v for v in description.modelVariables}
    assert not {"torque", "rod.angle", "rod.x", "spring.stiffness"} & set(variables)
    torque = variables["Motor.Trq"]
    assert (torque.unit, float(torque.min), float(torque.max)) == ("N.m", -0.03, 0.03)
    assert variables["Rod[1].Angle"].unit == "deg"
    assert "rod.angle of ALi3" in variables["Rod[1].Angle"].description
    assert variables["rod.ay"].unit == "m/s2"
    factor = next(u.baseUnit.factor for u in description.unitDefinitions if u.name == "deg")
    assert float(factor) == pytest.approx(math.pi / 180.0)
    with zipfile.ZipFile(renamed_crane) as archive:
        name = next(n for n in archive.namelist() if n.endswith("_in_turn_out.csv"))
        head, *rows = archive.read(name).decode().splitlines()
        input_lines = archive.read(name.replace("_out", "_in")).decode().splitlines()
        scene = archive.read("resources/geometry.json").decode()
    columns = dict(
        zip((c.strip('"') for c in head.split(",")), np.array([r.split(",") for r in rows], float).T, strict=True)
    )
    # cos(angle) / 2 m is where the centre of the rod lies
    assert columns["X"] == pytest.approx(500.0 * np.cos(columns["Rod[1].Angle"] / DEGREES), rel=1e-9)
    assert input_lines[0] == '"time","Motor.Trq"'
    assert '"rod.angle"' not in scene


def test_fmpy_the_c_host_and_libcosim_get_the_same_bits(host, renamed_crane, tmp_path) -> None:
    driven = host(renamed_crane).start({"Motor.Trq": -4e-3})
    driven.run(50, 0.01)
    names = ("X", "Rod[1].Angle")
    actual = [driven.get(n) for n in names]
    assert list(by_c_host(renamed_crane, tmp_path, {"Motor.Trq": -4e-3}, names, 50, 0.01)[-1]) == actual
    if importlib.util.find_spec("libcosimpy") is None:
        return
    late = host(renamed_crane).start()
    late.set("Motor.Trq", -4e-3)  # libcosim sets it after initialisation
    late.run(50, 0.01)
    actual = by_libcosim(renamed_crane, {"Motor.Trq": -4e-3}, names, 50, 0.01)[-1]
    assert list(actual) == [late.get(n) for n in names]


def test_names_that_cannot_be(tmp_path: Path) -> None:
    for text, message in (
        ('partial = true\nspeed = "v"', "this model has none of the variables that it names"),
        ('torqe = "T"', "'torqe': this model has no such variable; did you mean 'torque'"),
        ('torque = { name = "T", units = "kN.m" }', "'torque' has 'units'; known are name, factor, offset, unit"),
        ('torque = "rod.x"', "Two variables are named 'rod.x'"),
        ('torque = "1st torque"', "'1st torque' cannot be the name of an FMU variable"),
        ('torque = { name = "T", factor = 0.0 }', "'torque': factor is 0; it must be another number"),
        ('torque = { name = "T", unit = "furlong" }', "Unit 'furlong' is not understood"),
        ('torque = { name = "T", unit = "deg" }', "'torque' is in N.m, and deg is of another quantity"),
        ('"solver.status" = { name = "S", unit = "N" }', "'solver.status' is in 1, and N is of another quantity."),
        ('torque = { name = "T", factor = "gain" }', "'torque': factor is 'gain'; it must be a number, or a constant"),
    ):
        with pytest.raises(UserError, match=message):
            named(tmp_path, text)


def test_what_an_answer_is_watched_by_keeps_its_unit(tmp_path: Path) -> None:
    """Points, normals and places of a wheel are triples; its friction is watched by nobody."""
    bound = ("road_x", "road_y", "road_height", "road_normal_y", "road_normal_z", "y", "z", "vx")
    lines = [f'"{name}" = {{ name = "other.{name}", factor = 1e3 }}' for name in (*bound, "road_friction", "load")]
    (tmp_path / "names.toml").write_text("\n".join(lines), encoding="utf-8")
    table = variable_table(load_scene(f"{SCENES}:answered")[1].meta, pose=False, step_size=0.01)
    actual = renamed(table, read_content(tmp_path / "names.toml"))
    assert set(actual.named) == {"road_friction", "load"}
    assert set(actual.left_out) == set(bound)
    assert "is of a port, which works in m" in actual.left_out["road_height"]


def test_variables_without_another_name_are_reported_with_the_reason(tmp_path: Path) -> None:
    table = variable_table(load_scene(f"{SCENES}:crane")[1].meta, pose=False, step_size=0.01)
    for text, why in (
        ('"spring.stiffness" = { name = "C", factor = 1e-3 }', "another unit"),
        ('torque = { name = "T", offset = 1.0 }', "another zero"),
        ('"solver.status" = { name = "S", factor = 2.0 }', "another unit"),
        ('torque = { name = "T", factor = "gain" }\n[needs]\ngain = "a gain, 1"', "it needs 'gain' (a gain, 1)"),
    ):
        (tmp_path / "names.toml").write_text('"rod.x" = "X"\n' + text, encoding="utf-8")
        actual = renamed(table, read_content(tmp_path / "names.toml"))
        assert set(actual.named) == {"rod.x"}
        assert why in next(iter(actual.left_out.values()))


@pytest.mark.slow
def test_a_body_on_the_ground_and_a_road_without_friction_are_reported_under_other_names(host, tmp_path) -> None:
    """The force of the ground counts downwards; the friction is set while driving."""
    (tmp_path / "names.toml").write_text(
        '"chassis.ground_force" = { name = "Body.Fz", factor = -1e-3 }\n"road.friction" = "Mu"\n', encoding="utf-8"
    )
    name, system = load_scene("prototype_car")
    path = build_fmu(system, name, tmp_path, [fmpy.platform], names=read_content(tmp_path / "names.toml"))
    driven = host(path).start({"payload.passenger.mass": 900.0})
    (messages,) = [m for m in driven.messages if "At the start the vehicle rests on its body" in m]
    force = driven.get("Body.Fz")
    assert force < -1.0
    assert f"Body.Fz is {force:.4g}" in messages
    assert driven.step(0.0, 0.01) == 0
    for value, reported in ((0.05, False), (0.01, True), (0.0, True)):
        before = len(driven.messages)
        assert driven.set("Mu", value) == 0
        lines = [m for m in driven.messages[before:] if f"'Mu' was set to {value:g}" in m]
        assert len(lines) == reported
        assert not reported or "outside the range in which such vehicles work, 0.02257 to 2" in lines[0]
