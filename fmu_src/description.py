"""modelDescription.xml (FMI 2.0, co-simulation) from the table of variables."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from xml.etree import ElementTree

from fmu_src.units import DISPLAY_UNITS, QUANTITIES, canonical_unit, parse_unit
from fmu_src.variables import Variable

# Fixed, so that the same sources give the same bytes.
GENERATION_DATE = "2000-01-01T00:00:00Z"

LOG_CATEGORIES = {
    "logStatusWarning": "Values clamped, step size far from the tuned one",
    "logStatusDiscard": "Steps that were refused; the last good state is kept",
    "logStatusError": "Values and calls that were refused",
    "logStatusFatal": "Failures after which the instance cannot be used",
    "logAll": "Everything",
}


@dataclass(frozen=True)
class Description:
    """What modelDescription.xml says beside the variables.

    Parameters
    ----------
    model_name, model_identifier, guid, description, tool, version : str
        Attributes of the document.
    stop_time, step_size : float
        Default experiment, s.
    needs_execution_tool : bool
        Whether a Python interpreter must be there.
    capable : bool
        Whether the slave interpolates inputs, gives derivatives and respects the host's memory functions.
    sources : sequence of str
        C files in the folder ``sources``, if it can be compiled from them.
    """

    model_name: str
    model_identifier: str
    guid: str
    description: str
    tool: str
    version: str
    stop_time: float
    step_size: float
    needs_execution_tool: bool
    capable: bool = False
    sources: Sequence[str] = ()


def number(value: float) -> str:
    """Shortest text that reads back as the same double."""
    return repr(float(value))


def model_description(head: Description, table: Sequence[Variable]) -> bytes:
    """Write the document.

    Parameters
    ----------
    head : Description
        Attributes and default experiment.
    table : sequence of Variable
        All variables; the place is the value reference.

    Returns
    -------
    bytes
        UTF-8, the same for the same arguments.
    """
    root = ElementTree.Element(
        "fmiModelDescription",
        fmiVersion="2.0",
        modelName=head.model_name,
        guid=head.guid,
        description=head.description,
        version=head.version,
        generationTool=head.tool,
        generationDateAndTime=GENERATION_DATE,
        variableNamingConvention="structured",
        numberOfEventIndicators="0",
    )
    capable = str(head.capable).lower()
    face = ElementTree.SubElement(
        root,
        "CoSimulation",
        modelIdentifier=head.model_identifier,
        needsExecutionTool=str(head.needs_execution_tool).lower(),
        canHandleVariableCommunicationStepSize="true",
        canInterpolateInputs=capable,
        maxOutputDerivativeOrder="1" if head.capable else "0",
        canRunAsynchronuously="false",
        canBeInstantiatedOnlyOncePerProcess="false",
        canNotUseMemoryManagementFunctions=str(not head.capable).lower(),
        canGetAndSetFMUstate="true",
        canSerializeFMUstate="true",
        providesDirectionalDerivative=capable,
    )
    if head.sources:
        files = ElementTree.SubElement(face, "SourceFiles")
        for name in head.sources:
            ElementTree.SubElement(files, "File", name=name)
    units(root, table)
    _types(root, table)
    categories_and_experiment(root, head)
    variables = ElementTree.SubElement(root, "ModelVariables")
    types = declared_types(table)
    for reference, v in enumerate(table):
        _variable(variables, reference, v, types)
    _structure(root, table)
    return to_bytes(root)


def to_bytes(root: ElementTree.Element) -> bytes:
    """UTF-8 text of a document, indented."""
    ElementTree.indent(root)
    return bytes(ElementTree.tostring(root, encoding="UTF-8", xml_declaration=True)) + b"\n"


def categories_and_experiment(root: ElementTree.Element, head: Description) -> None:
    """Log categories and default experiment; the same in FMI 2.0 and 3.0."""
    categories = ElementTree.SubElement(root, "LogCategories")
    for name, text in LOG_CATEGORIES.items():
        ElementTree.SubElement(categories, "Category", name=name, description=text)
    ElementTree.SubElement(
        root, "DefaultExperiment", startTime="0.0", stopTime=number(head.stop_time), stepSize=number(head.step_size)
    )


def units(root: ElementTree.Element, table: Sequence[Variable]) -> None:
    """Definitions of all units in use; the same in FMI 2.0 and 3.0."""
    definitions = ElementTree.SubElement(root, "UnitDefinitions")
    for name in sorted({v.unit for v in table}):
        unit = parse_unit(name)
        element = ElementTree.SubElement(definitions, "Unit", name=name)
        attributes = {base: str(exponent) for base, exponent in unit.exponents.items()}
        if unit.factor != 1.0:
            attributes["factor"] = number(unit.factor)
        ElementTree.SubElement(element, "BaseUnit", attributes)
        if name in DISPLAY_UNITS:
            display, factor = DISPLAY_UNITS[name]
            ElementTree.SubElement(element, "DisplayUnit", name=display, factor=number(factor))


def type_name(v: Variable) -> str:
    """Name of the declared type of a variable: its quantity and, where it has one, its range."""
    name = QUANTITIES.get(canonical_unit(v.unit), "Quantity_" + re.sub(r"\W", "_", v.unit))
    if v.min is None and v.max is None:
        return name if v.display_unit is not None or v.unit not in DISPLAY_UNITS else f"{name}_plain"
    return f"{name}_{_end(v.min)}_to_{_end(v.max)}"


def type_attributes(v: Variable) -> dict[str, str]:
    """Attributes of the declared type of a variable."""
    attributes = {"quantity": QUANTITIES.get(canonical_unit(v.unit), "Quantity"), "unit": v.unit}
    if v.display_unit is not None:
        attributes["displayUnit"] = v.display_unit
    for key, value in (("min", v.min), ("max", v.max)):
        if value is not None:
            attributes[key] = number(value)
    return attributes


def declared_types(table: Sequence[Variable]) -> dict[str, dict[str, str]]:
    """Attributes of all declared types by name, sorted."""
    types: dict[str, dict[str, str]] = {}
    for v in table:
        types.setdefault(declared_type(v, types), type_attributes(v))
    return dict(sorted(types.items()))


def declared_type(v: Variable, types: dict[str, dict[str, str]]) -> str:
    """Name of a variable's type among the declared ones; a new name if none of them is it."""
    name, k = type_name(v), 2
    while name in types and types[name] != type_attributes(v):
        name, k = f"{type_name(v)}_{k}", k + 1
    return name


def _end(value: float | None) -> str:
    return "open" if value is None else f"{value:g}".replace("-", "minus").replace("+", "").replace(".", "p")


def _types(root: ElementTree.Element, table: Sequence[Variable]) -> None:
    definitions = ElementTree.SubElement(root, "TypeDefinitions")
    for name, attributes in declared_types(table).items():
        ElementTree.SubElement(ElementTree.SubElement(definitions, "SimpleType", name=name), "Real", attributes)


def _variable(parent: ElementTree.Element, reference: int, v: Variable, types: dict[str, dict[str, str]]) -> None:
    attributes = {"name": v.name, "valueReference": str(reference)}
    if v.description:
        attributes["description"] = v.description
    attributes |= {"causality": v.causality, "variability": v.variability}
    if v.causality != "input":
        attributes["initial"] = "calculated" if v.causality == "output" else "exact"
    scalar = ElementTree.SubElement(parent, "ScalarVariable", attributes)
    real = {"declaredType": declared_type(v, types), "unit": v.unit}
    if v.display_unit is not None:
        real["displayUnit"] = v.display_unit
    for key, value in (("min", v.min), ("max", v.max), ("start", v.start)):
        if value is not None:
            real[key] = number(value)
    ElementTree.SubElement(scalar, "Real", real)


def _structure(root: ElementTree.Element, table: Sequence[Variable]) -> None:
    """Outputs belong to the end of the last step, so no input reaches them at once; initial ones depend on all set."""
    structure = ElementTree.SubElement(root, "ModelStructure")
    unknowns = [i for i, v in enumerate(table, start=1) if v.causality == "output"]
    if not unknowns:
        return
    known = [str(i) for i, v in enumerate(table, start=1) if v.causality != "output" and v.source != "step_size"]
    outputs = ElementTree.SubElement(structure, "Outputs")
    for i in unknowns:
        ElementTree.SubElement(outputs, "Unknown", index=str(i), dependencies="")
    initial = ElementTree.SubElement(structure, "InitialUnknowns")
    for i in unknowns:
        ElementTree.SubElement(
            initial,
            "Unknown",
            index=str(i),
            dependencies=" ".join(known),
            dependenciesKind=" ".join(["dependent"] * len(known)),
        )
