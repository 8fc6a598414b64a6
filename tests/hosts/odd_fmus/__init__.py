"""Small FMUs that do what no FMU should, each one C file around `small.h`."""

from __future__ import annotations

import zipfile
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


def odd_fmu(name: str, folder: Path, *defines: str) -> Path:
    """The FMU of a C file of this folder, compiled for this machine. `defines`: ``NAME=VALUE`` for the compiler."""
    library = folder / f"{name}{fmpy.sharedLibraryExtension}"
    what = f"the FMU {name}"
    include = (HERE, _HEADERS)
    build.compile_c([HERE / f"{name}.c"], build.host_target(), library, include=include, defines=defines, what=what)
    fmu = folder / f"{name}.fmu"
    with zipfile.ZipFile(fmu, "w") as archive:
        archive.writestr("modelDescription.xml", _DESCRIPTION.format(name=name))
        archive.write(library, f"binaries/{fmpy.platform}/{library.name}")
    return fmu
