"""The XML documents of an FMI 3.0 co-simulation FMU: model description, build description, terminals."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree import ElementTree

from fmu_src.arrays import Array
from fmu_src.description import (
    GENERATION_DATE,
    Description,
    categories_and_experiment,
    declared_type,
    declared_types,
    number,
    to_bytes,
    type_attributes,
    units,
)
from fmu_src.variables import Variable


def model_description_fmi3(head: Description, table: Sequence[Variable], arrays: Sequence[Array]) -> bytes:
    """modelDescription.xml of FMI 3.0.

    Parameters
    ----------
    head : Description
    table : sequence of Variable
        All scalars, for units and types.
    arrays : sequence of Array
        The place is the value reference; time comes after the last.

    Returns
    -------
    bytes
    """
    root = ElementTree.Element(
        "fmiModelDescription",
        fmiVersion="3.0",
        modelName=head.model_name,
        instantiationToken=head.guid,
        description=head.description,
        version=head.version,
        generationTool=head.tool,
        generationDateAndTime=GENERATION_DATE,
        variableNamingConvention="structured",
    )
    ElementTree.SubElement(
        root,
        "CoSimulation",
        modelIdentifier=head.model_identifier,
        canGetAndSetFMUState="true",
        canSerializeFMUState="true",
        providesDirectionalDerivatives="true",
        providesAdjointDerivatives="true",
        canHandleVariableCommunicationStepSize="true",
        maxOutputDerivativeOrder="1",
    )
    units(root, table)
    types = declared_types(table)
    definitions = ElementTree.SubElement(root, "TypeDefinitions")
    for name, attributes in types.items():
        ElementTree.SubElement(definitions, "Float64Type", {"name": name} | attributes)
    categories_and_experiment(root, head)
    variables = ElementTree.SubElement(root, "ModelVariables")
    for reference, array in enumerate(arrays):
        _variable(variables, reference, array, types)
    ElementTree.SubElement(
        variables,
        "Float64",
        name="time",
        valueReference=str(len(arrays)),
        causality="independent",
        variability="continuous",
        description="Simulation time",
        unit="s",
    )
    _structure(root, arrays)
    return to_bytes(root)


def build_description(model_identifier: str, sources: Sequence[str]) -> bytes:
    """sources/buildDescription.xml: the C files, in C11 without fused arithmetic."""
    root = ElementTree.Element("fmiBuildDescription", fmiVersion="3.0")
    configuration = ElementTree.SubElement(root, "BuildConfiguration", modelIdentifier=model_identifier)
    files = ElementTree.SubElement(configuration, "SourceFileSet", language="C11", compilerOptions="-ffp-contract=off")
    for name in sources:
        ElementTree.SubElement(files, "SourceFile", name=name)
    return to_bytes(root)


def terminals(arrays: Sequence[Array]) -> bytes | None:
    """terminalsAndIcons.xml: one terminal per part of the model that has a name and more than one output; or None."""
    parts: dict[str, list[Array]] = {}
    for array in arrays:
        prefix, dot, _ = array.name.rpartition(".")
        if dot and array.of.causality == "output":
            parts.setdefault(prefix, []).append(array)
    parts = {name: members for name, members in parts.items() if len(members) > 1}
    if not parts:
        return None
    root = ElementTree.Element("fmiTerminalsAndIcons", fmiVersion="3.0")
    holder = ElementTree.SubElement(root, "Terminals")
    for name, members in parts.items():
        terminal = ElementTree.SubElement(holder, "Terminal", name=name, matchingRule="bus")
        for member in members:
            ElementTree.SubElement(
                terminal,
                "TerminalMemberVariable",
                variableName=member.name,
                memberName=member.name.rpartition(".")[2],
                variableKind="signal",
            )
    return to_bytes(root)


def _variable(parent: ElementTree.Element, reference: int, array: Array, types: dict[str, dict[str, str]]) -> None:
    v = array.of
    attributes = {"name": array.name, "valueReference": str(reference)}
    if array.description:
        attributes["description"] = array.description
    attributes |= {"causality": v.causality, "variability": v.variability}
    own = type_attributes(v)
    attributes["declaredType"] = declared_type(v, types)
    if v.causality == "parameter":
        attributes["initial"] = "exact"
    attributes |= {key: own[key] for key in ("unit", "displayUnit", "min", "max") if key in own}
    if v.start is not None:
        attributes["start"] = number(v.start)
    element = ElementTree.SubElement(parent, "Float64", attributes)
    if len(array.items) > 1:
        ElementTree.SubElement(element, "Dimension", start=str(len(array.items)))


def _structure(root: ElementTree.Element, arrays: Sequence[Array]) -> None:
    structure = ElementTree.SubElement(root, "ModelStructure")
    outputs = [str(i) for i, a in enumerate(arrays) if a.of.causality == "output"]
    known = [str(i) for i, a in enumerate(arrays) if a.of.causality != "output" and a.of.source != "step_size"]
    for reference in outputs:
        ElementTree.SubElement(structure, "Output", valueReference=reference, dependencies="")
    for reference in outputs:
        ElementTree.SubElement(
            structure,
            "InitialUnknown",
            valueReference=reference,
            dependencies=" ".join(known),
            dependenciesKind=" ".join(["dependent"] * len(known)),
        )
