"""Parameter sets: SSV files between an FMU, its hosts and other readers, with units, refusals and round trips."""

import struct
from contextlib import nullcontext
from pathlib import Path

import fmpy
import pytest
import xmlschema
from fmpy.model_description import BaseUnit, DisplayUnit, Item, ModelDescription, ScalarVariable, SimpleType, Unit
from fmpy.ssp.ssd import read_ssv
from hypothesis import given, settings
from hypothesis import strategies as st
from pyssp_standard.ssv import SSV
from pyssp_standard.standard import ModelicaStandard

import mbs
from ali3.errors import UserError
from ali3.read_parameter_set import read_parameter_set
from ali3.unit_definition import UnitDefinition
from ali3.write_parameter_set import is_as_built, write_parameter_set
from fmu_src.build.build import FmuBuilder, build_fmu
from fmu_src.build.car_registry import build_car
from fmu_src.build.scene_registry import load_scene
from fmu_src.variables.parameter_file import write_beside
from hosts.check.command import main as check
from hosts.common.errors import HostError
from hosts.fmu.fmu import Fmu
from hosts.fmu.parameters_as_set import parameter_set_of
from hosts.fmu.settings import Settings
from hosts.fmu.variables import Variables
from tests.hosts.parameter_files import UNITS, ssv

HERE = Path(__file__).parent
NAMES = ["spring.stiffness", "spring.damping", "spring.free_length", "step_size", "solver.step_iterations"]


def entry(name: str, element: str) -> str:
    return f'<ssv:Parameter name="{name}"><ssv:{element}/></ssv:Parameter>'


@pytest.fixture
def variables(tuned: Path) -> Variables:
    return Variables(fmpy.read_model_description(str(tuned)))


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "set.ssv"


def taken(variables: Variables, file: Path, text: str) -> Settings:
    file.write_text(text)
    settings = Settings(variables)
    settings.add_set(file)
    return settings


def bits(value: float) -> bytes:
    return struct.pack("<d", value)


def test_what_a_build_writes_every_reader_reads(tuned, file):
    name, system = load_scene(f"{HERE / 'scenes.py'}:tuned")
    builder = FmuBuilder(system, name, 0, ("", "", ""), lambda *_: nullcontext())
    assert write_beside(builder.parameters, file)
    assert check([str(tuned), "--save-parameters", str(file.with_name("shown.ssv"))]) == 0
    assert file.read_bytes() == file.with_name("shown.ssv").read_bytes()
    for schema in ("ssv", "ssv2"):  # what is right in 1.0 is right in 2.0
        xmlschema.validate(str(file), str(ModelicaStandard.schemas[schema]))
    description = {v.name: v for v in fmpy.read_model_description(str(tuned)).modelVariables}
    assert [p.name for p in read_ssv(str(file)).parameters] == NAMES
    with SSV(str(file)) as other:
        second = {p["name"]: p["type_value"].parameter for p in other.parameters}
        units = {unit.name: unit.base_unit.to_dict() for unit in other.units}
    for p in read_ssv(str(file)).parameters:
        assert bits(float(p.value)) == bits(float(description[p.name].start)) == bits(float(second[p.name]["value"]))
        assert p.unit == description[p.name].unit == second[p.name].get("unit")
    assert units["N.s/m"] == {"kg": "1", "s": "-1", "factor": "1.0"}
    text = file.read_text()
    assert "Of the spring: stiffness; 10 to 900 N/m; tunable" in text
    assert "Of the spring: free_length; 0.1 to 2 m; fixed" in text


def test_values_come_back_to_the_last_bit(tuned, file):
    odd = {
        "spring.stiffness": 100.0 / 3.0,
        "spring.damping": 0.1 + 0.2,
        "spring.free_length": 1.1e-1,
        "step_size": 1e-3,
    }
    options = [text for n, x in odd.items() for text in ("--set", f"{n}={x!r}")]
    assert check([str(tuned), *options, "--save-parameters", str(file)]) == 0
    assert not is_as_built(file)
    with Fmu(tuned) as fmu:
        settings = Settings(fmu.table)
        settings.add_set(file)
        fmu.initialise(settings.start)
        back = fmu.getter(list(odd))()
    assert [bits(x) for x in back] == [bits(x) for x in odd.values()]
    other = {p.name: float(p.value) for p in read_ssv(str(file)).parameters}
    assert [bits(other[name]) for name in odd] == [bits(x) for x in odd.values()]


@pytest.mark.parametrize(
    ("entry", "value", "message"),
    [
        ("spring.stiffness=0.25[kN/m]", 250.0, "100 -> 250 N/m (0.25 kN/m in set.ssv)"),
        ("spring.free_length=500[mm]", 0.5, "0.8 -> 0.5 m (500 mm in set.ssv)"),
        ("spring.free_length=0.05[m]", 0.5, "0.05 m in set.ssv"),  # the file's m is ten of ours
        ("spring.stiffness=250[N/m]", 250.0, "100 -> 250 N/m (set.ssv)"),
        ('<ssv:Parameter name="spring.stiffness"><ssv:Integer value="250"/></ssv:Parameter>', 250.0, "(set.ssv)"),
    ],
)
def test_units_are_converted_by_their_definitions(variables, file, entry, value, message):
    result = taken(variables, file, ssv(entry))
    (actual,) = result.start.values()
    assert actual == pytest.approx(value, rel=1e-15)
    assert any(message in text for _, text in result.rows())


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (ssv("spring.stiffness=2[kN/mm]"), "given in 'kN/mm', which the file does not define among its Units"),
        (ssv("spring.stiffness=2[1/s2]"), r"given in 1/s2 \(s-2\); its unit is N/m \(kg.s-2\)"),
        (ssv("spring.stiffness=2[Nm/deg]"), r"given in Nm/deg \(57.2958 kg.m2.s-2.rad-1\)"),
        (
            ssv("spring.stiffness=2[kN/m]"),
            "set.ssv, 2 kN/m: 'spring.stiffness' is 2000 N/m; its range is 10 to 900 N/m",
        ),
        (ssv("spring.stiffness=NaN"), "'spring.stiffness' is nan; only finite numbers"),
        (ssv("spring.stifness=20"), "no parameter or input 'spring.stifness'; did you mean 'spring.stiffness'"),
        (ssv(f"a&#10;{'b' * 200}=2"), r"no parameter or input 'a\\nbbbbb.*[.]{3}; it has: "),
        (ssv("bob.x=2"), "'bob.x' is an output of the FMU"),
        (ssv("spring.mass=2"), "'spring.mass' is a constant, 0.1 kg; it cannot be set"),
        (ssv("spring.damping=2", "spring.damping=3"), "the parameter 'spring.damping' occurs twice"),
        (ssv(entry("spring.damping", 'String value="2"')), "is given as String; in the FMU it is a Real"),
        (ssv("spring.damping=3e"), "set.ssv, line 1: 'spring.damping' is '3e'; a number is needed"),
        (
            ssv("spring.damping=2", units=UNITS.replace('"1000"', '"100e"')),
            "set.ssv, line 1: the unit 'kN/m' has factor = '100e'; a number is needed",
        ),
        (ssv("spring.damping=2,5"), "line 1: Element 'Real', attribute 'value': '2,5' is not a valid value"),
        (ssv(entry("spring.damping", 'Number value="2"')), "line 1: Element 'Number': This element is not expected"),
        (ssv("spring.damping=1").replace('version="1.0"', 'version="3.0"'), "is of SSP '3.0'; 1.0 and 2.0"),
        (ssv("spring.damping=1", units=UNITS.replace('"0.001"', '"-1"')), "unit 'mm' has the factor -1"),
        (ssv("spring.damping=1", units=UNITS.replace('"mm"', '"inch"')), "the unit 'inch' occurs twice"),
        (ssv(entry("spring.damping", 'Float64 value="1 2"'), version="2.0"), "'spring.damping' has 2 values"),
        ("<a/>", "is not an SSV file: its root is 'a'"),
        ("spring.damping = 3", "is not an XML document"),
        ('<!DOCTYPE a [<!ENTITY b "c">]>' + ssv("spring.damping=1"), "document type declaration"),
    ],
)
def test_unusable_values_are_refused_in_one_sentence(variables, file, text, message):
    file.write_text(text)
    settings = Settings(variables)
    with pytest.raises(UserError, match=message) as raised:
        settings.add_set(file)
    assert "\n" not in str(raised.value)
    assert str(raised.value).endswith((".", "?"))
    assert "set.ssv" in str(raised.value)
    assert settings.start == {}  # nothing of the file


def test_version_2_is_read_and_comments_annotations_and_enumerations_are_passed_over(variables, file):
    note = '<ssv:Annotations><ssc:Annotation type="org.test"><a b="1"/></ssc:Annotation></ssv:Annotations>'
    kinds_of = '<ssv:Enumerations><ssc:Enumeration name="g"><!-- g --><ssc:Item name="a" value="1"/></ssc:Enumeration>'
    text = ssv(
        f'<!-- softer --><ssv:Parameter name="spring.damping"><!-- was 1 --><?x y?><ssv:Float64 value="2.5"/>{note}'
        "</ssv:Parameter>",
        entry("spring.stiffness", 'Int32 value="40"'),
        entry("spring.free_length", 'Float32 value="500" unit="mm"'),
        version="2.0",
    )
    text = text.replace("<ssv:Units>", f"{kinds_of}</ssv:Enumerations><ssv:Units><!-- units -->")
    assert taken(variables, file, text.replace("</ssv:Units>", f"</ssv:Units>{note}")).start == {
        "spring.damping": 2.5,
        "spring.stiffness": 40.0,
        "spring.free_length": 0.5,
    }


def test_display_units_of_the_fmu_are_known(file):
    degree = DisplayUnit(name="deg", factor=57.29577951308232)
    celsius = DisplayUnit(name="degC", factor=1.0, offset=-273.15)
    units = [
        Unit(name="rad", baseUnit=BaseUnit(rad=1), displayUnits=[degree]),
        Unit(name="K", baseUnit=BaseUnit(K=1), displayUnits=[celsius]),
        Unit(name="x"),
    ]
    result = [
        ScalarVariable(name=name, type="Real", causality="parameter", variability="fixed", start="0", unit=unit)
        for name, unit in (("angle", "rad"), ("heat", "K"), ("odd", "x"))
    ]
    actual = taken(
        Variables(ModelDescription(modelVariables=result, unitDefinitions=units)),
        file,
        ssv("angle=90[deg]", "heat=20[degC]", "odd=3[x]"),
    )
    assert actual.start == pytest.approx({"angle": 1.5707963267948966, "heat": 293.15, "odd": 3.0}, rel=1e-15)
    assert ("heat", "0 -> 293.15 K (20 degC in set.ssv)") in actual.rows()
    with pytest.raises(UserError, match="the FMU does not define its unit x"):
        taken(Variables(ModelDescription(modelVariables=result, unitDefinitions=units)), file, ssv("odd=3[mm]"))


@settings(max_examples=60, deadline=None)
@given(places=st.lists(st.tuples(st.integers(0, 2000), st.integers(0, 255)), min_size=1, max_size=6))
def test_altered_files_are_refused_or_read(tmp_path_factory, places):
    data = bytearray(ssv("spring.damping=2[kN/m]", entry("n", 'Integer value="3"')).encode())
    for place, byte in places:
        data[place % len(data)] = byte
    file = tmp_path_factory.getbasetemp() / "altered.ssv"
    file.write_bytes(bytes(data))
    message = ""
    try:
        read_parameter_set(file)
    except UserError as error:
        message = str(error)
    assert "\n" not in message


def kinds() -> Variables:
    """An FMU of all kinds."""
    gear = SimpleType(name="Gear", type="Enumeration", items=[Item("low", "1"), Item("high", "2")])
    variables = [
        ScalarVariable(name="count", type="Integer", causality="parameter", variability="fixed", start="3", min="0"),
        ScalarVariable(name="on", type="Boolean", causality="parameter", variability="tunable", start="false"),
        ScalarVariable(name="road", type="String", causality="parameter", variability="fixed", start="flat"),
        ScalarVariable(
            name="gear", type="Enumeration", causality="parameter", variability="fixed", start="1", declaredType=gear
        ),
        ScalarVariable(name="depth", type="Real", causality="parameter", variability="fixed", start="1", max="4"),
    ]
    return Variables(ModelDescription(modelVariables=variables))


def test_every_kind_goes_out_and_comes_back(file):
    values = {"count": 7, "on": True, "road": "a b.npz", "gear": 2, "depth": -1.5}
    write_parameter_set(parameter_set_of(kinds(), "all", values), file, as_built=False)
    xmlschema.validate(str(file), str(ModelicaStandard.schemas["ssv"]))
    settings = Settings(kinds())
    settings.add_set(file)
    assert settings.start == values
    assert [type(x) for x in settings.start.values()] == [int, bool, str, int, float]
    assert {p.name: p.value for p in read_ssv(str(file)).parameters}["gear"] == "high"
    by_hand = Settings(kinds())
    by_hand.add_texts(
        [("count", "7"), ("on", "true"), ("road", "a b.npz"), ("gear", "high"), ("depth", "-1.5")], "--set"
    )
    assert by_hand.start == values


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("count", "2.5", "'count' is 2.5; it must be a whole number"),
        ("count", "three", "'count': 'three' is not a number"),
        ("on", "yes", "'on' is 'yes'; it must be true or false"),
        ("gear", "3", "'gear' is 3; its range is 1 low, 2 high"),
        ("depth", "5", "'depth' is 5; its range is up to 4"),
    ],
)
def test_values_of_the_command_line_are_of_their_kind(name, text, message):
    with pytest.raises(HostError, match=message):
        Settings(kinds()).add_texts([(name, text)], "--set")


@pytest.mark.parametrize(("name", "kind"), [("depth", "a Real"), ("count", "an Integer"), ("gear", "an Enumeration")])
def test_a_truth_value_is_no_number(name, kind):
    with pytest.raises(HostError, match=f"'{name}' is true; it must be {kind}"):
        Settings(kinds()).add_numbers({name: True}, "start of drive")


def test_units_with_an_offset():
    kelvin, celsius = UnitDefinition({"K": 1}), UnitDefinition({"K": 1}, 1.0, 273.15)
    assert kelvin.convert(293.15, celsius) == pytest.approx(20.0, rel=1e-12)
    fahrenheit = UnitDefinition({"K": 1}, 5 / 9, 459.67 * 5 / 9)
    assert fahrenheit.convert(212.0, celsius) == pytest.approx(100.0, rel=1e-12)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('value="1.0" unit="N.s/m"', 'value="2.0" unit="N.s/m"'),
        ("</ssv:Parameters>", ""),  # damaged
        ('fileversion="', 'fileversion="x'),
    ],
)
def test_a_set_that_a_person_has_edited_is_kept(variables, file, old, new):
    assert write_beside(parameter_set_of(variables, "Tuned", {}), file)
    assert is_as_built(file)
    built = file.read_text()
    assert write_beside(parameter_set_of(variables, "Tuned", {}), file)
    assert old in built
    file.write_text(built.replace(old, new))
    assert not write_beside(parameter_set_of(variables, "Tuned", {}), file)
    assert file.read_text() == built.replace(old, new)


def test_a_picture_names_the_changed_values():
    settings = Settings(kinds())
    settings.add_numbers({"depth": 2.0}, "start of rest")
    assert settings.title("car") == "car"
    settings.add_texts([("count", "4"), ("on", "true"), ("gear", "2")], "--set")
    assert settings.title("car") == "car, count 4, on true, 1 more"


@pytest.mark.slow
def test_a_set_of_all_parameters_of_a_car_is_the_engine_with_them(file, tmp_path):
    car = build_car("hatchback")
    fmu = build_fmu(car.systems[0], car.name, tmp_path, [fmpy.platform])
    system = car.systems[0]
    changed = {}
    for p in system.meta["parameters"]:
        low, high = max(p["min"], p["value"] - 1.0), min(p["max"], 1.03 * p["value"] + 0.1)
        changed[p["name"]] = high if high > p["value"] else low
    assert len(changed) > 30
    options = [text for n, x in changed.items() for text in ("--set", f"{n}={x!r}")]
    assert check([str(fmu), *options, "--save-parameters", str(file)]) == 0
    simulation = mbs.Simulation(system, parameters=changed)
    for _ in range(50):
        simulation.step(0.002)
    with Fmu(fmu) as driven:
        settings = Settings(driven.table)
        settings.add_set(file)
        assert {s.variable.name for s in settings.changes} == set(changed)
        driven.initialise(settings.start)
        for k in range(50):
            driven.step(0.002 * k, 0.002)
        computed = {entry["name"] for entry in system.meta["sensors"] if entry.get("computed", True)}
        names = [n for n in driven.names("output") if n in computed]
        assert len(names) > 100
        actual = dict(zip(names, driven.getter(names)(), strict=True))
    assert actual == {n: simulation.sensors[n] for n in names}
