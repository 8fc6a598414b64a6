"""Small faulty FMUs, each one C file around `small.h`."""

import zipfile
from collections.abc import Mapping
from pathlib import Path

import fmpy

from mbs.kernel import build

HERE = Path(__file__).parent
_HEADERS = Path(fmpy.__file__).parent / "c-code"
_DESCRIPTION = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="{name}" guid="{{small}}" author="ALi3" copyright="none" license="none">
  <CoSimulation modelIdentifier="{name}" canHandleVariableCommunicationStepSize="true" canGetAndSetFMUstate="true"
    canSerializeFMUstate="true"/>
  <UnitDefinitions><Unit name="m"/></UnitDefinitions>
  <DefaultExperiment startTime="0" stopTime="1" stepSize="0.01"/>
  <ModelVariables>
    <ScalarVariable name="u" valueReference="0" causality="input"><Real start="0" unit="m"/></ScalarVariable>
    <ScalarVariable name="y" valueReference="1" causality="output"><Real unit="m" nominal="1"/></ScalarVariable>
  </ModelVariables>
  <ModelStructure>
    <Outputs><Unknown index="2"/></Outputs>
    <InitialUnknowns><Unknown index="2"/></InitialUnknowns>
  </ModelStructure>
</fmiModelDescription>
"""


_DESCRIPTION_3 = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="{name}" instantiationToken="{{small}}" author="ALi3" copyright="none"
  license="none">
  <CoSimulation modelIdentifier="{name}" canHandleVariableCommunicationStepSize="true" canGetAndSetFMUState="true"
    canSerializeFMUState="true"/>
  <UnitDefinitions><Unit name="m"/></UnitDefinitions>
  <DefaultExperiment startTime="0" stopTime="1" stepSize="0.01"/>
  <ModelVariables>
    <Float64 name="u" valueReference="0" causality="input" start="0" unit="m"/>
    <Float64 name="y" valueReference="1" causality="output" unit="m" nominal="1"/>
    <Float64 name="time" valueReference="2" causality="independent" variability="continuous"/>
  </ModelVariables>
  <ModelStructure>
    <Output valueReference="1"/>
    <InitialUnknown valueReference="1"/>
  </ModelStructure>
</fmiModelDescription>
"""


def planted_fmu(folder: Path, plant: str, three: bool, changes: Mapping[str, str] | None = None) -> Path:
    """An FMU with one fault of `plants.h`; `changes`: of its description, new texts by old ones."""
    derivatives = {
        "canHandleVariable": f'providesDirectionalDerivative{"s" if three else ""}="true" canHandleVariable',
        '<Unknown index="2"/></Outputs>': '<Unknown index="2" dependencies=""/></Outputs>',
        '<Output valueReference="1"/>': '<Output valueReference="1" dependencies=""/>',
        'unit="m" nominal': 'unit="m" min="-10" max="10" nominal',
    }
    return odd_fmu(
        "planted3" if three else "planted", folder, f"PLANT={plant}", changes=derivatives | dict(changes or {})
    )


def odd_fmu(name: str, folder: Path, *defines: str, changes: Mapping[str, str] | None = None) -> Path:
    """The FMU of a C file of this folder, compiled for this machine.

    `defines`: ``NAME=VALUE`` for the compiler; `changes`: of its description, new texts by old ones.
    """
    three = name.endswith("3")
    description = (_DESCRIPTION_3 if three else _DESCRIPTION).format(name=name)
    for old, new in (changes or {}).items():
        description = description.replace(old, new)
    library = folder / f"{name}{fmpy.sharedLibraryExtension}"
    label = f"the FMU {name}"
    include = (HERE, _HEADERS)
    build.compile_c([HERE / f"{name}.c"], build.host_target(), library, include=include, defines=defines, what=label)
    fmu = folder / f"{name}.fmu"
    with zipfile.ZipFile(fmu, "w") as archive:
        archive.writestr("modelDescription.xml", description)
        archive.write(library, f"binaries/{fmpy.platform_tuple if three else fmpy.platform}/{library.name}")
    return fmu
