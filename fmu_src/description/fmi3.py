"""The model description and the build description of an FMI 3.0 co-simulation FMU."""

from collections.abc import Mapping, Sequence
from xml.etree import ElementTree

from fmu_src.description.description import (
    DERIVATIVES,
    Description,
    about,
    categories_and_experiment,
    declared_type,
    declared_types,
    dependency_attributes,
    leading_attributes,
    span_of_derivatives,
    text_attributes,
    to_bytes,
    units,
    variable_attributes,
    with_texts,
)
from fmu_src.description.probe import Dependencies
from fmu_src.variables.arrays import Array, references
from fmu_src.variables.variables import Variable

ELEMENTS = "extra/org.ali3.elements/elements.txt"
"""Where an FMU with arrays says what their elements are called in the other kinds."""


def model_description_fmi3(
    head: Description, table: Sequence[Variable], arrays: Sequence[Array], reach: Dependencies
) -> bytes:
    """modelDescription.xml of FMI 3.0.

    `table`: all scalars, for units and types; `reach`: which variables of the table reach which outputs.
    """
    identification = {"fmiVersion": "3.0", "modelName": head.model_name, "instantiationToken": head.guid}
    root = ElementTree.Element("fmiModelDescription", identification | about(head))
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
        providesIntermediateUpdate="true",
        mightReturnEarlyFromDoStep="true",
    )
    units(root, table)
    types = declared_types(table)
    definitions = ElementTree.SubElement(root, "TypeDefinitions")
    for name, attributes in types.items():
        kind = "Float64Type" if "unit" in attributes else "Int32Type"
        ElementTree.SubElement(definitions, kind, {"name": name} | attributes)
    categories_and_experiment(root, head)
    variables = ElementTree.SubElement(root, "ModelVariables")
    numbers, time = references(arrays)
    for index, (reference, array) in enumerate(zip(numbers, arrays, strict=True)):
        if index == time:
            _time(variables, time)
        _variable(variables, reference, array, types, table)
    if time == len(arrays):
        _time(variables, time)
    for reference, text in enumerate(head.texts, start=len(arrays) + 1):
        element = ElementTree.SubElement(variables, "String", text_attributes(text, reference))
        ElementTree.SubElement(element, "Start", value=text.start)
    _structure(root, arrays, with_texts(table, reach, head.texts), (len(table), len(head.texts)))
    annotation = ElementTree.SubElement(ElementTree.SubElement(root, "Annotations"), "Annotation", type=DERIVATIVES)
    annotation.append(span_of_derivatives(table))
    return to_bytes(root)


def element_names(table: Sequence[Variable], arrays: Sequence[Array]) -> dict[str, bytes]:
    """The file at `ELEMENTS`, none without arrays: a line for each, its name and those of its elements.

    They stand beside the description, for FMI Library looks for the dimension of a variable before its annotations.
    """
    name_lists = [[array.name, *(table[k].name for k in array.items)] for array in arrays if len(array.items) > 1]
    return {ELEMENTS: "".join(" ".join(names) + "\n" for names in name_lists).encode()} if name_lists else {}


def build_description(model_identifier: str, sources: Sequence[str]) -> bytes:
    """sources/buildDescription.xml: the C files, in C11 without fused arithmetic."""
    root = ElementTree.Element("fmiBuildDescription", fmiVersion="3.0")
    configuration = ElementTree.SubElement(root, "BuildConfiguration", modelIdentifier=model_identifier)
    files = ElementTree.SubElement(configuration, "SourceFileSet", language="C11", compilerOptions="-ffp-contract=off")
    for name in sources:
        ElementTree.SubElement(files, "SourceFile", name=name)
    ElementTree.SubElement(
        configuration,
        "Library",
        name="m",
        external="true",
        description="The C library's mathematics, where it is apart",
    )
    return to_bytes(root)


def _time(parent: ElementTree.Element, reference: int) -> None:
    ElementTree.SubElement(
        parent,
        "Float64",
        name="time",
        valueReference=str(reference),
        causality="independent",
        variability="continuous",
        description="Simulation time",
        unit="s",
    )


def _variable(
    parent: ElementTree.Element,
    reference: int,
    array: Array,
    types: dict[str, dict[str, str]],
    table: Sequence[Variable],
) -> None:
    v = array.of
    attributes = leading_attributes(array.name, reference, array.description, v.causality, v.variability)
    attributes["declaredType"] = declared_type(v, types)
    if v.causality == "parameter":
        attributes["initial"] = "exact"
    if v.causality == "input" and not v.whole:
        attributes["intermediateUpdate"] = "true"
    attributes |= variable_attributes(v)
    if "start" in attributes:
        attributes["start"] = " ".join(variable_attributes(table[k])["start"] for k in array.items)
    element = ElementTree.SubElement(parent, "Int32" if v.whole else "Float64", attributes)
    if len(array.items) > 1:
        ElementTree.SubElement(element, "Dimension", start=str(len(array.items)))


def _structure(root: ElementTree.Element, arrays: Sequence[Array], reach: Dependencies, texts: tuple[int, int]) -> None:
    """`texts`: place of the first variable that is text, and how many there are."""
    structure = ElementTree.SubElement(root, "ModelStructure")
    array_of = {k: i for i, a in enumerate(arrays) for k in a.items}
    array_of |= {texts[0] + k: len(arrays) + 1 + k for k in range(texts[1])}
    outputs = [(i, a.items) for i, a in enumerate(arrays) if a.of.causality == "output"]
    for tag, reaching in (("Output", dict.fromkeys(reach.initial, ())), ("InitialUnknown", reach.initial)):
        for reference, items in outputs:
            attributes = {"valueReference": str(reference)} | dependency_attributes(_union(reaching, items, array_of))
            ElementTree.SubElement(structure, tag, attributes)


def _union(
    reaching: Mapping[int, Sequence[int] | None], items: Sequence[int], array_of: Mapping[int, int]
) -> list[int] | None:
    """Arrays that reach one of the items of an array; None if what reaches an item is not known."""
    lists = [reaching[item] for item in items]
    if None in lists:
        return None
    return sorted({array_of[k] for indices in lists for k in indices or ()})
