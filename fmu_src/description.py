"""modelDescription.xml (FMI 2.0, co-simulation) from the table of variables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from xml.etree import ElementTree

from fmu_src.units import DISPLAY_UNITS, parse_unit
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
    ElementTree.SubElement(
        root,
        "CoSimulation",
        modelIdentifier=head.model_identifier,
        needsExecutionTool=str(head.needs_execution_tool).lower(),
        canHandleVariableCommunicationStepSize="true",
        canInterpolateInputs="false",
        maxOutputDerivativeOrder="0",
        canRunAsynchronuously="false",
        canBeInstantiatedOnlyOncePerProcess="false",
        canNotUseMemoryManagementFunctions="true",
        canGetAndSetFMUstate="true",
        canSerializeFMUstate="true",
        providesDirectionalDerivative="false",
    )
    _units(root, table)
    categories = ElementTree.SubElement(root, "LogCategories")
    for name, text in LOG_CATEGORIES.items():
        ElementTree.SubElement(categories, "Category", name=name, description=text)
    ElementTree.SubElement(
        root,
        "DefaultExperiment",
        startTime="0.0",
        stopTime=number(head.stop_time),
        stepSize=number(head.step_size),
    )
    variables = ElementTree.SubElement(root, "ModelVariables")
    for reference, v in enumerate(table):
        _variable(variables, reference, v)
    _structure(root, table)
    ElementTree.indent(root)
    return bytes(ElementTree.tostring(root, encoding="UTF-8", xml_declaration=True)) + b"\n"


def _units(root: ElementTree.Element, table: Sequence[Variable]) -> None:
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


def _variable(parent: ElementTree.Element, reference: int, v: Variable) -> None:
    attributes = {"name": v.name, "valueReference": str(reference)}
    if v.description:
        attributes["description"] = v.description
    attributes |= {"causality": v.causality, "variability": v.variability}
    if v.causality != "input":
        attributes["initial"] = "calculated" if v.causality == "output" else "exact"
    scalar = ElementTree.SubElement(parent, "ScalarVariable", attributes)
    real = {"unit": v.unit}
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
