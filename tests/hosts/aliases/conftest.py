"""FMUs of one car in the names, units, signs and frames of other programs."""

from pathlib import Path

import pytest
from lxml import etree

from fmu_src.native.platforms import PYTHON_PLATFORMS, this_platform
from tests.hosts.changed_fmu import DESCRIPTION, changed_fmu

SOURCE = Path(__file__).with_name("foreign_car.py")
_BASE = {
    "km/h": {"m": "1", "s": "-1", "factor": repr(1 / 3.6)},
    "m/s": {"m": "1", "s": "-1"},
    "deg": {"rad": "1", "factor": repr(0.017453292519943295)},
    "deg/s": {"rad": "1", "s": "-1", "factor": repr(0.017453292519943295)},
    "rad": {"rad": "1"},
    "g": {"m": "1", "s": "-2", "factor": "9.80665"},
    "m": {"m": "1"},
    "MPa": {"kg": "1", "m": "-1", "s": "-2", "factor": "1e6"},
}


@pytest.fixture(scope="session")
def foreign_fmu(tmp_path_factory):
    """Builds the FMU of a style once, a Python slave."""
    if this_platform() not in PYTHON_PLATFORMS:
        pytest.skip("PythonFMU has no binary for this platform")
    from pythonfmu.builder import FmuBuilder

    results: dict[str, Path] = {}

    def build(style: str) -> Path:
        if style not in results:
            folder = tmp_path_factory.mktemp(style)
            script = folder / f"foreign_{style}.py"
            script.write_text(SOURCE.read_text("utf-8").replace('STYLE = "ours"', f'STYLE = "{style}"'), "utf-8")
            results[style] = Path(FmuBuilder.build_FMU(script, dest=folder))
        return results[style]

    return build


@pytest.fixture
def with_units(tmp_path):
    """A copy of an FMU that declares units of variables."""

    def declare(fmu: Path, units: dict[str, str]) -> Path:
        copy = tmp_path / f"{fmu.stem}_with_units.fmu"
        return changed_fmu(fmu, copy, {DESCRIPTION: lambda content: _declared(content, units)})

    return declare


def _declared(content: bytes, units: dict[str, str]) -> bytes:
    root = etree.fromstring(content)
    definitions = etree.Element("UnitDefinitions")
    for unit in sorted(set(units.values())):
        etree.SubElement(etree.SubElement(definitions, "Unit", name=unit), "BaseUnit", _BASE[unit])
    root.find("CoSimulation").addnext(definitions)
    for name, unit in units.items():
        root.find(f".//ScalarVariable[@name='{name}']/Real").set("unit", unit)
    return etree.tostring(root, xml_declaration=True, encoding="utf-8")
