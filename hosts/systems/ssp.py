"""A system of FMUs as an SSP archive, with a parameter set for each part, for programs that run such systems."""

from __future__ import annotations

import tempfile
import zipfile
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from xml.etree import ElementTree

from ali3.files import check_writable
from ali3.parameter_set import Entry, ParameterSet
from ali3.write_parameter_set import write_parameter_set
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.fmu.fmu import Fmu
from hosts.systems.wires import wires_of

_COMMON, _STRUCTURE = (
    "http://ssp-standard.org/SSP1/SystemStructureCommon",
    "http://ssp-standard.org/SSP1/SystemStructureDescription",
)


def write_ssp(
    file: Path, parts: Mapping[str, Path], connections: Mapping[str, str], start: Mapping[str, Value], name: str = ""
) -> Path:
    """Write an SSP of SSP 1.0: the FMUs, their connections, and an SSV of the start values of each.

    Parameters
    ----------
    file : Path
        Ends in ``.ssp``; an older one is replaced.
    parts : mapping of str to Path
        FMUs by the names of their components.
    connections : mapping of str to str
        Outputs by the inputs that take them, each as ``part.variable``.
    start : mapping of str to float, int or str
        Parameters and inputs of parts, as ``part.variable``.
    name : str
        Of the system; by default that of the file.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    HostError
        There is no such part or variable.
    """
    check_writable(file)
    root = ElementTree.Element(f"{{{_STRUCTURE}}}SystemStructureDescription", name=name or file.stem, version="1.0")
    system = ElementTree.SubElement(root, f"{{{_STRUCTURE}}}System", name=name or file.stem)
    elements = ElementTree.SubElement(system, f"{{{_STRUCTURE}}}Elements")
    content: dict[str, bytes] = {}
    with ExitStack() as stack, tempfile.TemporaryDirectory() as folder:
        fmus = {part: stack.enter_context(Fmu(Path(path))) for part, path in parts.items()}
        wires = wires_of(connections, fmus)
        for part, fmu in fmus.items():
            source = f"resources/{Path(parts[part]).name}"
            content[source] = Path(parts[part]).read_bytes()
            kind = "application/x-fmu-sharedlibrary"
            component = ElementTree.SubElement(
                elements, f"{{{_STRUCTURE}}}Component", name=part, type=kind, source=source
            )
            ends = {(w.output, "output") for w in wires if w.source == part}
            ends |= {(w.input, "input") for w in wires if w.target == part}
            connectors = ElementTree.SubElement(component, f"{{{_STRUCTURE}}}Connectors")
            for variable, causality in sorted(ends):
                end = ElementTree.SubElement(connectors, f"{{{_STRUCTURE}}}Connector", name=variable, kind=causality)
                ElementTree.SubElement(end, f"{{{_COMMON}}}{fmu.variables[variable].type}")
            values = _values(part, fmu, start)
            if values:
                place = f"resources/{part}.ssv"
                write_parameter_set(ParameterSet(part, values, {}), Path(folder, "values.ssv"), as_built=False)
                content[place] = Path(folder, "values.ssv").read_bytes()
                bindings = ElementTree.SubElement(component, f"{{{_STRUCTURE}}}ParameterBindings")
                ElementTree.SubElement(bindings, f"{{{_STRUCTURE}}}ParameterBinding", source=place)
    unknown = [text for text in start if text.partition(".")[0] not in parts]
    if unknown:
        raise HostError(f"'{unknown[0]}' names no part; the parts are {', '.join(parts)}.")
    joined = ElementTree.SubElement(system, f"{{{_STRUCTURE}}}Connections")
    for w in wires:
        ends_of = {
            "startElement": w.source,
            "startConnector": w.output,
            "endElement": w.target,
            "endConnector": w.input,
        }
        ElementTree.SubElement(joined, f"{{{_STRUCTURE}}}Connection", ends_of)
    ElementTree.register_namespace("ssd", _STRUCTURE)
    ElementTree.register_namespace("ssc", _COMMON)
    ElementTree.indent(root)
    document = ElementTree.tostring(root, encoding="UTF-8", xml_declaration=True)
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("SystemStructure.ssd", document)
        for path, data in content.items():
            archive.writestr(path, data)
    return file


def _values(part: str, fmu: Fmu, start: Mapping[str, Value]) -> list[Entry]:
    """Start values of a part as a parameter set has them."""
    found = []
    for text, value in start.items():
        owner, _, name = text.partition(".")
        if owner != part:
            continue
        if name not in (*fmu.names("parameter"), *fmu.names("input")):
            raise HostError(f"The part '{part}' has no parameter or input '{name}'.")
        kind = str(fmu.variables[name].type)
        found.append(Entry(name, kind, str(int(value)) if kind == "Integer" else repr(float(value)), None))
    return found
