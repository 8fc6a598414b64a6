"""A system of FMUs as an SSP archive, with a parameter set for each part, for programs that run such systems."""

import zipfile
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from os import PathLike
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement, indent, register_namespace, tostring

from ali3.files import atomic_file, check_writable
from ali3.message_text import brief
from ali3.parameter_set import Entry, ParameterSet
from ali3.temporary_folder import temporary_folder
from ali3.unit_definition import KINDS
from ali3.write_parameter_set import write_parameter_set
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.fmu.fmu import Fmu
from hosts.fmu.parameters_as_set import value_text
from hosts.systems.connections import Wire, fmus_of, starts_of, wires_of

_SSP = "http://ssp-standard.org/SSP1/SystemStructure"
_COMMON = f"{{{_SSP}Common}}"
_STRUCTURE = f"{{{_SSP}Description}}"
SET = "start"
"""Name of the parameter set of each part: Ecos applies the sets of the name that it is given."""

_VERSIONS = ("1.0", "2.0")


def write_ssp(
    file: Path,
    parts: Mapping[str, Path],
    connections: Mapping[str, str],
    start: Mapping[str, Value],
    name: str = "",
    version: str = "1.0",
) -> Path:
    """Write an SSP: the FMUs, their connections, and an SSV of the start values of each.

    Parameters
    ----------
    file : Path
        Ends in ``.ssp``; an older one is replaced.
    parts : mapping of str to Path
        FMUs by the names of their components.
    connections : mapping of str to str
        Outputs by the inputs that take them, each as ``part.variable``.
    start : mapping of str to float, int, bool or str
        Parameters and inputs of parts, as ``part.variable``; of an enumeration the number.
    name : str
        Of the system; by default that of the file.
    version : str
        Of SSP: ``1.0``, which has parts of FMI 2.0, or ``2.0``, which has parts of FMI 3.0 too.

    Raises
    ------
    HostError
        There is no such part or variable, a value is none of its variable, a name cannot be that of a file or part,
        SSP has no such version, or a wire ends at an element of an array.
    FileError
        The file cannot be written; an older one is then unchanged.
    """
    file = _checked_file(file, name, version)
    with ExitStack() as stack:
        folder = stack.enter_context(temporary_folder())
        fmus = fmus_of(parts, stack)
        wires = wires_of(connections, fmus)
        content = {f"resources/{part}.fmu": Path(path) for part, path in parts.items()}
        for part, values in starts_of(start, fmus).items():
            if values:
                parameter_file = content[f"resources/{part}.ssv"] = folder / f"{part}.ssv"
                write_parameter_set(ParameterSet(SET, _entries(fmus[part], values), {}), parameter_file, as_built=False)
        document = _document(name or file.stem, fmus, wires, content, version)
        with atomic_file(file) as temporary, zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr("SystemStructure.ssd", document)
            for member, path in content.items():
                archive.write(path, member)
    return file


def _checked_file(file: Path, name: str, version: str) -> Path:
    """The path of the archive. Raises `HostError` if an argument of `write_ssp` is wrong, or `FileError`."""
    if not isinstance(file, (str, PathLike)):
        raise HostError(f"The file of an SSP is {brief(file)}; it must be a path.")
    if (file := Path(file)).suffix != ".ssp":
        raise HostError(f"{file}: the name of an SSP ends in .ssp.")
    if not isinstance(name, str) or not name.isprintable():
        raise HostError(f"The name of the system is {brief(name)}; it must be a text that can be printed.")
    if version not in _VERSIONS:
        raise HostError(f"The version of SSP is {brief(version)}; it must be {' or '.join(_VERSIONS)}.")
    check_writable(file)
    return file


def _document(
    name: str, fmus: Mapping[str, Fmu], wires: Sequence[Wire], content: Mapping[str, Path], version: str
) -> bytes:
    """The description of the system, without empty elements, which its schema does not allow."""
    root = Element(f"{_STRUCTURE}SystemStructureDescription", name=name, version=version)
    system = SubElement(root, f"{_STRUCTURE}System", name=name)
    if fmus:
        elements = SubElement(system, f"{_STRUCTURE}Elements")
        for part, fmu in fmus.items():
            _component(elements, part, fmu, wires, content, version)
    if wires:
        connections = SubElement(system, f"{_STRUCTURE}Connections")
        for w in wires:
            ends = {"startElement": w.source, "startConnector": w.output, "endElement": w.target}
            SubElement(connections, f"{_STRUCTURE}Connection", ends | {"endConnector": w.input})
    register_namespace("ssd", _STRUCTURE[1:-1])
    register_namespace("ssc", _COMMON[1:-1])
    indent(root)
    document: bytes = tostring(root, encoding="UTF-8", xml_declaration=True)
    return document


def _component(
    elements: Element, part: str, fmu: Fmu, wires: Sequence[Wire], content: Mapping[str, Path], version: str
) -> None:
    """Add a part with the ends of its wires and its parameter set."""
    kind = "application/x-fmu-sharedlibrary"
    component = SubElement(elements, f"{_STRUCTURE}Component", name=part, type=kind, source=f"resources/{part}.fmu")
    ends = {(w.output, "output") for w in wires if w.source == part}
    ends |= {(w.input, "input") for w in wires if w.target == part}
    if ends:
        connectors = SubElement(component, f"{_STRUCTURE}Connectors")
        for variable, causality in sorted(ends):
            end = SubElement(connectors, f"{_STRUCTURE}Connector", name=variable, kind=causality)
            (scalar,) = fmu.scalars([variable])
            if scalar.size > 1:
                raise HostError(f"'{part}.{variable}' is a part of an array; SSP wires whole variables only.")
            kind = KINDS.get(scalar.type, scalar.type) if version == "1.0" else scalar.type
            SubElement(end, f"{_COMMON}{kind}")
    if (values := f"resources/{part}.ssv") in content:
        bindings = SubElement(component, f"{_STRUCTURE}ParameterBindings")
        SubElement(bindings, f"{_STRUCTURE}ParameterBinding", source=values)


def _entries(fmu: Fmu, values: Mapping[str, Value]) -> list[Entry]:
    """Start values of a part as entries of a parameter set."""
    variables = {name: fmu.table.settable(name, "") for name in values}
    return [Entry(name, v.kind, value_text(v, values[name]), None) for name, v in variables.items()]
