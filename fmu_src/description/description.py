"""modelDescription.xml (FMI 2.0, co-simulation) from the table of variables."""

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from xml.etree import ElementTree

from fmu_src.description.probe import Dependencies
from fmu_src.variables.text_variables import TextVariable
from fmu_src.variables.units import DISPLAY_UNITS, QUANTITIES, parse_unit
from fmu_src.variables.variables import Variable
from mbs.elements.road import ANSWER
from mbs.model.records import Role

# Of this version: the same sources give the same bytes, so that no clock is read.
RELEASE_DATE = "2026-11-20T00:00:00Z"

DERIVATIVES = "org.ali3.derivatives"
"""Name of the annotation that says what directional derivatives span."""

LOG_CATEGORIES = {
    "logStatusWarning": "Values clamped, step size far from the tuned one",
    "logStatusDiscard": "Steps that were refused; the last good state is kept",
    "logStatusError": "Values and calls that were refused",
    "logStatusFatal": "Failures after which the instance cannot be used",
    "logNotComputed": "Outputs that were read but are not computed by this FMU; a warning, given once",
    "logAll": "Everything",
}


@dataclass(frozen=True)
class Description:
    """Content of modelDescription.xml other than the variables."""

    model_name: str
    model_identifier: str
    guid: str
    description: str
    tool: str
    version: str
    """`model_name`, `model_identifier`, `guid`, `description`, `tool`, `version`: attributes of the document."""
    stop_time: float
    step_size: float
    """`stop_time`, `step_size`: default experiment, s."""
    needs_execution_tool: bool
    """Whether a Python interpreter must be there, which has memory of its own."""
    author: str
    copyright: str
    licence: str
    """`author`, `copyright`, `licence`: of the model; by default those of the solver."""
    sources: Sequence[str] = ()
    """C files in the folder ``sources``, if it can be compiled from them."""
    texts: Sequence[TextVariable] = ()
    """Variables that are text; their value references come after those of the others."""


def generation_date() -> str:
    """The date of the environment variable SOURCE_DATE_EPOCH, else that of this version."""
    epoch = os.environ.get("SOURCE_DATE_EPOCH", "")
    if not epoch:
        return RELEASE_DATE
    try:
        return datetime.fromtimestamp(int(epoch), UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
    except (ValueError, OverflowError, OSError):
        raise ValueError(f"SOURCE_DATE_EPOCH is '{epoch}'; seconds since 1970 are needed.") from None


def about(head: Description) -> dict[str, str]:
    """Attributes of a model description that FMI 2.0 and 3.0 share, in their order."""
    return {
        "description": head.description,
        "author": head.author,
        "version": head.version,
        "copyright": head.copyright,
        "license": head.licence,
        "generationTool": head.tool,
        "generationDateAndTime": generation_date(),
        "variableNamingConvention": "structured",
    }


def number(value: float) -> str:
    """Shortest text that reads back as the same double."""
    return repr(float(value))


def model_description(head: Description, table: Sequence[Variable], reach: Dependencies) -> bytes:
    """Write the document.

    `head`: attributes and default experiment; `table`: all variables; the place is the value reference. Result: UTF-8,
    the same for the same arguments.
    """
    identification = {"fmiVersion": "2.0", "modelName": head.model_name, "guid": head.guid}
    root = ElementTree.Element("fmiModelDescription", {**identification, **about(head), "numberOfEventIndicators": "0"})
    co_simulation = ElementTree.SubElement(
        root,
        "CoSimulation",
        modelIdentifier=head.model_identifier,
        needsExecutionTool=str(head.needs_execution_tool).lower(),
        canHandleVariableCommunicationStepSize="true",
        canInterpolateInputs="true",
        maxOutputDerivativeOrder="1",
        canRunAsynchronuously="false",
        canBeInstantiatedOnlyOncePerProcess="false",
        canNotUseMemoryManagementFunctions=str(head.needs_execution_tool).lower(),
        canGetAndSetFMUstate="true",
        canSerializeFMUstate="true",
        providesDirectionalDerivative="true",
    )
    if head.sources:
        files = ElementTree.SubElement(co_simulation, "SourceFiles")
        for name in head.sources:
            ElementTree.SubElement(files, "File", name=name)
    units(root, table)
    _types(root, table)
    categories_and_experiment(root, head)
    tool = ElementTree.SubElement(ElementTree.SubElement(root, "VendorAnnotations"), "Tool", name=DERIVATIVES)
    tool.append(span_of_derivatives(table))
    variables = ElementTree.SubElement(root, "ModelVariables")
    types = declared_types(table)
    for reference, v in enumerate(table):
        _variable(variables, reference, v, types)
    for reference, text in enumerate(head.texts, start=len(table)):
        scalar = ElementTree.SubElement(variables, "ScalarVariable", text_attributes(text, reference))
        ElementTree.SubElement(scalar, "String", start=text.start)
    _structure(root, with_texts(table, reach, head.texts))
    return to_bytes(root)


def to_bytes(root: ElementTree.Element) -> bytes:
    """UTF-8 text of a document, indented."""
    ElementTree.indent(root)
    return bytes(ElementTree.tostring(root, encoding="UTF-8", xml_declaration=True)) + b"\n"


def span_of_derivatives(table: Sequence[Variable]) -> ElementTree.Element:
    """What directional derivatives after the initialisation are over, which FMI has no word for.

    `addedAlong`: inputs that a step reaches from their last values: derivatives by them are by what is added all along.
    """
    answers = [i for i, v in enumerate(table) if v.role == Role.ANSWER]
    reached = " ".join(table[i + k].name for i in answers for k in range(len(ANSWER)))
    attributes = {"addedAlong": reached} if reached else {}
    return ElementTree.Element("DirectionalDerivatives", {"span": "communicationStep"} | attributes)


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
    for name in sorted({v.unit for v in table if not v.whole}):
        unit = parse_unit(name, foreign=True)  # those of models were checked with their names
        element = ElementTree.SubElement(definitions, "Unit", name=name)
        attributes = {base: str(exponent) for base, exponent in unit.exponents.items()}
        if unit.factor != 1.0:
            attributes["factor"] = number(unit.factor)
        ElementTree.SubElement(element, "BaseUnit", attributes)
        if name in DISPLAY_UNITS:
            for display, factor in DISPLAY_UNITS[name].items():
                ElementTree.SubElement(element, "DisplayUnit", name=display, factor=number(factor))


def type_name(v: Variable) -> str:
    """Name of the declared type of a variable: its quantity, or else its unit; a display unit that is not the usual."""
    if v.whole:
        return "Count"
    name = QUANTITIES.get(v.unit, f"Value_in_{_plain(v.unit)}")
    if v.display_unit != next(iter(DISPLAY_UNITS.get(v.unit, {})), None):
        name += f"_in_{_plain(v.display_unit or v.unit)}"
    return name


def type_attributes(v: Variable) -> dict[str, str]:
    """Attributes of the declared type of a variable; its range stands at the variable."""
    if v.whole:
        return {"quantity": "Count"}
    attributes = {"quantity": QUANTITIES[v.unit]} if v.unit in QUANTITIES else {}
    attributes["unit"] = v.unit
    if v.display_unit is not None:
        attributes["displayUnit"] = v.display_unit
    return attributes


def value_text(v: Variable, value: float) -> str:
    """A number of a variable as its type is written."""
    return str(int(value)) if v.whole else number(value)


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


def _plain(unit: str) -> str:
    return re.sub(r"\W+", "_", unit)


def _types(root: ElementTree.Element, table: Sequence[Variable]) -> None:
    definitions = ElementTree.SubElement(root, "TypeDefinitions")
    for name, attributes in declared_types(table).items():
        kind = "Real" if "unit" in attributes else "Integer"
        ElementTree.SubElement(ElementTree.SubElement(definitions, "SimpleType", name=name), kind, attributes)


def _variable(parent: ElementTree.Element, reference: int, v: Variable, types: dict[str, dict[str, str]]) -> None:
    attributes = leading_attributes(v.name, reference, v.description, v.causality, v.variability)
    if v.causality != "input":
        attributes["initial"] = "calculated" if v.causality == "output" else "exact"
    scalar = ElementTree.SubElement(parent, "ScalarVariable", attributes)
    value = {"declaredType": declared_type(v, types)} | variable_attributes(v)
    ElementTree.SubElement(scalar, "Integer" if v.whole else "Real", value)


def leading_attributes(name: str, reference: int, description: str, causality: str, variability: str) -> dict[str, str]:
    """Attributes that all variables begin with; the same in FMI 2.0 and 3.0."""
    attributes = {"name": name, "valueReference": str(reference)}
    if description:
        attributes["description"] = description
    return attributes | {"causality": causality, "variability": variability}


def text_attributes(text: TextVariable, reference: int) -> dict[str, str]:
    """Attributes of a variable that is text; the same in FMI 2.0 and 3.0."""
    return leading_attributes(text.name, reference, text.description, "parameter", "fixed") | {"initial": "exact"}


def variable_attributes(v: Variable) -> dict[str, str]:
    """Unit, range, typical size and start of a variable; the same in FMI 2.0 and 3.0."""
    attributes = {} if v.whole else {"unit": v.unit}
    if v.display_unit is not None:
        attributes["displayUnit"] = v.display_unit
    for key, value in (("min", v.min), ("max", v.max), ("nominal", v.nominal), ("start", v.start)):
        if value is not None:
            attributes[key] = value_text(v, value)
    return attributes


def with_texts(table: Sequence[Variable], reach: Dependencies, texts: Sequence[TextVariable]) -> Dependencies:
    """The same where initial outputs depend on texts too, whose places are behind the table.

    A road decides where a start stands: what depends on the initial place depends on the road.
    """
    pose_indices = [i for i, v in enumerate(table) if v.source == "pose"]
    if not texts or not pose_indices:
        return reach
    indices_of_texts = tuple(range(len(table), len(table) + len(texts)))
    initial = {
        i: dependencies
        if dependencies is None or not set(pose_indices) & set(dependencies)
        else (*dependencies, *indices_of_texts)
        for i, dependencies in reach.initial.items()
    }
    return replace(reach, initial=initial)


def _structure(root: ElementTree.Element, reach: Dependencies) -> None:
    """Outputs depend on no input before the next step, initial ones on all that was found to change them."""
    structure = ElementTree.SubElement(root, "ModelStructure")
    initial = reach.initial
    for tag, dependencies in (("Outputs", dict.fromkeys(initial, ())), ("InitialUnknowns", initial)):
        group = ElementTree.Element(tag)
        for i in dependencies:
            ElementTree.SubElement(group, "Unknown", {"index": str(i + 1)} | dependency_attributes(dependencies[i], 1))
        if len(group):
            structure.append(group)


def dependency_attributes(dependencies: Sequence[int] | None, offset: int = 0) -> dict[str, str]:
    """Attributes of an unknown that depends on the variables at these places, None: all; `offset` is added to them."""
    if dependencies is None:
        return {}
    attributes = {"dependencies": " ".join(str(k + offset) for k in dependencies)}
    if dependencies:
        attributes["dependenciesKind"] = " ".join(["dependent"] * len(dependencies))
    return attributes
