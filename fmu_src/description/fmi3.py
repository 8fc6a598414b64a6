"""The XML documents of an FMI 3.0 co-simulation FMU: model description, build description, terminals."""

from collections.abc import Sequence
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
from mbs.elements.road import ANSWER

ELEMENTS = "extra/org.ali3.elements/elements.txt"
"""Where an FMU with arrays says what their elements are called in the other kinds."""

LS_NAMESPACE = "http://fmi-standard.org/fmi-ls-manifest"
LS_STRUCT = "org.fmi-standard.fmi-ls-struct"
"""Of modelica/fmi-ls-struct, whose terminals are maps: the release candidate 1 of 1.0."""
MAPS = f"{LS_STRUCT}.map"


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


def terminals(arrays: Sequence[Array]) -> bytes:
    """terminalsAndIcons.xml: the place of the icon; a terminal per part of the model that has a name and more than one
    variable from outside or to outside, one of the inputs without such a name, and one per table.
    """
    groups: dict[str, list[Array]] = {}
    for array in arrays:
        prefix, _, _ = array.name.rpartition(".")
        if array.of.causality == "input" or (prefix and array.of.causality == "output"):
            groups.setdefault(prefix, []).append(array)
    controls = groups.pop("", [])
    if controls:
        has_steering = "steering" in {array.name for array in controls}
        groups = {"driver" if has_steering and "driver" not in groups else "inputs": controls} | groups
    root = ElementTree.Element("fmiTerminalsAndIcons", fmiVersion="3.0")
    picture = ElementTree.SubElement(root, "GraphicalRepresentation")
    corners = {"x1": "-100", "y1": "-100", "x2": "100", "y2": "100"}
    ElementTree.SubElement(picture, "CoordinateSystem", corners | {"suggestedScalingFactorTo_mm": "0.1"})
    ElementTree.SubElement(picture, "Icon", corners)
    groups = {name: members for name, members in groups.items() if len(members) > 1}
    plugs, tables = _plugs(arrays), tables_of(arrays)
    parent = ElementTree.SubElement(root, "Terminals") if groups or plugs or tables else root
    for name, members in groups.items():
        terminal = ElementTree.SubElement(parent, "Terminal", name=name, matchingRule="bus")
        for member in members:
            ElementTree.SubElement(
                terminal,
                "TerminalMemberVariable",
                variableName=member.name,
                memberName=member.name.rpartition(".")[2],
                variableKind="signal",
            )
    for name, members in tables.items():
        attributes = {"name": name, "terminalKind": f"{MAPS}.rectilinearGrid", "matchingRule": MAPS}
        terminal = ElementTree.SubElement(parent, "Terminal", attributes)
        for member in members:
            member_attributes = {"variableName": member.name, "memberName": member.name.rpartition(".")[2]}
            member_attributes["variableKind"] = f"{MAPS}.{'domain' if member is members[0] else 'codomain'}"
            ElementTree.SubElement(terminal, "TerminalMemberVariable", member_attributes)
    for name, ports in plugs:
        terminal = ElementTree.SubElement(parent, "Terminal", name=name, matchingRule="plug")
        for variable, member_name, kind in ports:
            member_attributes = {"variableName": variable, "memberName": member_name, "variableKind": kind}
            ElementTree.SubElement(terminal, "TerminalMemberVariable", member_attributes)
    return to_bytes(root)


def tables_of(arrays: Sequence[Array]) -> dict[str, list[Array]]:
    """Arrays of constants of one length under one name: the points of a table, then its values there."""
    by_prefix: dict[str, list[Array]] = {}
    for array in arrays:
        prefix, _, _ = array.name.rpartition(".")
        if array.of.source == "constant" and len(array.items) > 1 and prefix:
            by_prefix.setdefault(prefix, []).append(array)
    return {
        name: members
        for name, members in by_prefix.items()
        if len(members) > 1 and len({len(a.items) for a in members}) == 1
    }


def map_manifest(arrays: Sequence[Array]) -> dict[str, bytes]:
    """Manifest of the layered standard by which terminals are maps, by its path; nothing where there are none."""
    if not tables_of(arrays):
        return {}
    description = "Layered standard for structuring of variables"
    root = manifest("fmiLayeredStandardManifest", name=LS_STRUCT, version="1.0.0-rc.1", description=description)
    return {f"extra/{LS_STRUCT}/fmi-ls-manifest.xml": to_bytes(root)}


def manifest(tag: str, **named: str) -> ElementTree.Element:
    """Root of a manifest of a layered standard; `named`: its attributes, without what all of them begin with."""
    ElementTree.register_namespace("fmi-ls", LS_NAMESPACE)
    return ElementTree.Element(tag, {f"{{{LS_NAMESPACE}}}fmi-ls-{name}": value for name, value in named.items()})


_FORCE = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")

# By the last part of the name of its first port: what a terminal is called, and its members, each the last part of the
# name of a variable, the name that a partner has for it, and its kind. Those that a model does not have are left out.
_PLUGS: dict[str, tuple[str, tuple[tuple[str, str, str], ...]]] = {
    "drive_torque": ("drive_torque_port", (("drive_torque", "flow", "inflow"), ("omega", "potential", "signal"))),
    "steering_rack_actuator_force": (
        "steering_rack_actuator_force_port",
        (("steering_rack_actuator_force", "flow", "inflow"), ("steering_rack", "potential", "signal")),
    ),
    "road_x": (
        "road_port",
        (
            *((f"road_{name}", name, "signal") for name in ANSWER),
            *((name, name, "signal") for name in ("contact", "contact_x", "contact_y", "contact_z")),
            *((f"road_ahead_{c}", f"ahead_{c}", "signal") for c in "xy"),
        ),
    ),
    "hub_Fx": (
        "hub_port",
        (
            *((f"hub_{name}", name, "inflow") for name in _FORCE),
            *((name, name, "signal") for name in ("position", "x", "y", "z", "axis", "axis_x", "axis_y", "axis_z")),
            *((f"earth_v{c}", f"v{c}", "signal") for c in "xyz"),
            *((f"axis_rate_{c}", f"axis_rate_{c}", "signal") for c in "xyz"),
            ("omega", "omega", "signal"),
        ),
    ),
    "Fx": (
        "port",
        (
            *((name, name, "inflow") for name in _FORCE),
            *((name, name, "signal") for name in ("position", "x", "y", "z", "velocity", "vx", "vy", "vz")),
        ),
    ),
}


def _plugs(arrays: Sequence[Array]) -> list[tuple[str, list[tuple[str, str, str]]]]:
    """Names and members of the terminals of ports: variable, name for the partner, kind."""
    names = {(array.of.ours if len(array.items) == 1 else "") or array.name: array.name for array in arrays}
    plugs = []
    for ours, array in zip(names, arrays, strict=True):
        prefix, dot, suffix = ours.rpartition(".")
        if not array.of.port or suffix not in _PLUGS:
            continue
        terminal_name, members = _PLUGS[suffix]
        candidates = [(f"{prefix}{dot}{name}", member, kind) for name, member, kind in members]
        candidates = [
            (names[variable_name], member, kind) for variable_name, member, kind in candidates if variable_name in names
        ]
        if len(candidates) > 1:
            plugs.append((f"{prefix}{dot}{terminal_name}", candidates))
    return plugs


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
    initial = reach.initial
    for tag, dependencies_of in (("Output", dict.fromkeys(initial, ())), ("InitialUnknown", initial)):
        for i, a in enumerate(arrays):
            if a.of.causality == "output":
                dependency_lists = [dependencies_of[item] for item in a.items]
                dependencies = (
                    None
                    if None in dependency_lists
                    else sorted({array_of[k] for indices in dependency_lists for k in indices or ()})
                )
                ElementTree.SubElement(structure, tag, {"valueReference": str(i)} | dependency_attributes(dependencies))
