"""Reads parameter sets and checks them by the XML schema of the standard."""

import os
import re
from collections.abc import Iterable
from typing import Any

from ali3.parameter_set import Entry, ParameterSet, ParameterSetError
from ali3.reading import read_bytes
from ali3.unit_definition import KINDS, UnitDefinition
from ali3.xml_memory import is_lack_of_memory

LARGEST = 10_000_000
"""Largest size of a file, bytes."""

_SCHEMAS = {"1": "ssv", "2": "ssv2"}


def read_parameter_set(file: str | os.PathLike[str]) -> ParameterSet:
    """Read an SSV file of SSP 1.0 or 2.0, checked against the standard's XML schema.

    Entries are in the order of the file, with the types of SSP 1.0. Raises `ParameterSetError` if the file has another
    format, a name occurs twice, or a value is a list; `FileError` if the file cannot be read.
    """
    from pyssp_standard.ssv import SSVElem

    root = _document_root(file)
    schema = _schema(root, file)
    if not schema.validate(root):
        problem = schema.error_log[0]
        raise ParameterSetError(f"{file}, line {problem.line}: {_plain_message(problem.message)}.")
    _check_units(root, SSVElem.namespaces, file)
    content = SSVElem.from_xml(root)
    elements = root.iterfind("ssv:Parameters/ssv:Parameter", SSVElem.namespaces)
    entries = [
        _entry(parameter["name"], parameter["type_name"], element, f"{file}, line {element.sourceline}")
        for parameter, element in zip(content.parameters, elements, strict=True)
    ]
    _check_unique((e.name for e in entries), f"{file}: the parameter", "a set gives each one once")
    units = list(root.iterfind("ssv:Units/ssc:Unit", SSVElem.namespaces))
    _check_unique((u.get("name") for u in units), f"{file}: the unit", "a file defines each one once")
    definitions = {u.name: UnitDefinition.of(u.base_unit.to_dict()) for u in content.units or ()}
    for name, unit in definitions.items():
        if not (unit.factor > 0.0 and abs(unit.factor) + abs(unit.offset) < float("inf")):
            raise ParameterSetError(
                f"{file}: the unit '{name}' has the factor {unit.factor:g} and the offset {unit.offset:g}; a factor is "
                "positive, both are finite."
            )

    return ParameterSet(content.name, entries, definitions, root.get("fileversion", ""))


def _document_root(file: str | os.PathLike[str]) -> Any:
    """Root of the document; a document type declaration, and thus entities, are refused."""
    from lxml import etree

    data = read_bytes(file, LARGEST, name=f"The parameter set {file}")
    try:
        # the library would treat a comment as an element
        parser = etree.XMLParser(resolve_entities=False, no_network=True, remove_comments=True, remove_pis=True)
        root = etree.fromstring(data, parser)
    except etree.XMLSyntaxError as error:
        if is_lack_of_memory(error):
            raise MemoryError from None
        raise ParameterSetError(
            f"{file} is not an XML document: {_plain_message(error.msg or 'it is empty')}."
        ) from None
    if root.getroottree().docinfo.doctype:
        raise ParameterSetError(f"{file} has a document type declaration; a parameter set has none.")
    return root


def _schema(root: Any, file: object) -> Any:
    """Schema of the version that the document declares."""
    from lxml import etree
    from pyssp_standard.standard import ModelicaStandard

    if root.tag != f"{{{ModelicaStandard.namespaces['ssv']}}}ParameterSet":
        root_name = etree.QName(root).localname
        raise ParameterSetError(
            f"{file} is not an SSV file: its root is '{root_name}' where ParameterSet of the SSP standard must be."
        )
    version = root.get("version", "")
    if version[:1] not in _SCHEMAS:
        raise ParameterSetError(f"{file} is of SSP '{version}'; 1.0 and 2.0 can be read.")
    return etree.XMLSchema(file=str(ModelicaStandard.schemas[_SCHEMAS[version[:1]]]))


def _check_units(root: Any, namespaces: dict[str, str], file: object) -> None:
    """Check the numbers of units, since errors of the library name neither file nor unit."""
    for unit in root.iterfind("ssv:Units/ssc:Unit", namespaces):
        for name, value in ((n, v) for base in unit for n, v in base.attrib.items()):
            _check_number(value, f"{file}, line {unit.sourceline}: the unit '{unit.get('name')}' has {name} =")


def _check_number(text: str, prefix: str) -> None:
    """Check a number by Python, because libxml2 accepts "1e"."""
    try:
        float(text)
    except ValueError:
        raise ParameterSetError(f"{prefix} '{text}'; a number is needed.") from None


def _entry(name: str, kind: str, element: Any, where: str) -> Entry:
    """The entry of an element, whose type may be one of SSP 2.0."""
    value_element = element[0]
    value = value_element.get("value")
    if value is None:
        values = [v.get("value") for v in value_element.iterfind("{*}Value")]
        if len(values) != 1:
            raise ParameterSetError(f"{where}: '{name}' has {len(values)} values; one is needed.")
        value = values[0]
    kind = KINDS.get(kind, kind)
    if kind in ("Real", "Integer", "Boolean") and len(value.split()) != 1:
        raise ParameterSetError(f"{where}: '{name}' has {len(value.split())} values; one is needed.")
    if kind not in ("String", "Enumeration"):
        value = value.strip()
    if kind == "Real":
        _check_number(value, f"{where}: '{name}' is")
    return Entry(name, kind, value, value_element.get("unit"), element.get("description", ""))


def _check_unique(names: Iterable[str], prefix: str, rule: str) -> None:
    """Refuse a name that occurs twice, by a sentence with the prefix and the rule."""
    known_names: set[str] = set()
    for name in names:
        if name in known_names:
            raise ParameterSetError(f"{prefix} '{name}' occurs twice; {rule}.")
        known_names.add(name)


def _plain_message(message: str) -> str:
    """A message of the schema without namespaces and full stop."""
    return " ".join(re.sub(r"\{[^{}]*\}", "", message).split()).rstrip(".")
