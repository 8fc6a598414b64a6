"""Parameter sets: SSV files of the SSP standard, read by its XML schema and written by `pyssp_standard`."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from hashlib import sha256
from importlib.metadata import version
from pathlib import Path
from typing import Any

from ali3.errors import FileError, UserError
from ali3.files import reason, whole_file

BASE_UNITS = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")
"""Base units of the standards SSP and FMI."""
LARGEST = 10_000_000
"""Bytes that a file may have."""

_KINDS = {"Float64": "Real", "Float32": "Real"} | {
    f"{sign}Int{bits}": "Integer" for sign in ("", "U") for bits in (8, 16, 32, 64)
}
_SCHEMAS = {"1": "ssv", "2": "ssv2"}


class ParameterSetError(UserError):
    """A parameter set that cannot be used; the message says what is wrong with it."""


@dataclass(frozen=True)
class UnitDefinition:
    """A unit by its base units: value in base units = factor * value + offset.

    Parameters
    ----------
    exponents : mapping of str to int
        By name of the base unit; those that are zero left out.
    factor, offset : float
    """

    exponents: Mapping[str, int]
    factor: float = 1.0
    offset: float = 0.0

    @classmethod
    def of(cls, attributes: Mapping[str, Any]) -> UnitDefinition:
        """A definition from the attributes of an element ``BaseUnit`` of SSP or FMI.

        Parameters
        ----------
        attributes : mapping of str to str or number
            Exponents by base unit, ``factor`` and ``offset``; what is missing has its default.
        """
        exponents = {base: int(attributes.get(base) or 0) for base in BASE_UNITS}
        factor, offset = attributes.get("factor"), attributes.get("offset")
        return cls(
            {base: exponent for base, exponent in exponents.items() if exponent},
            1.0 if factor is None else float(factor),
            0.0 if offset is None else float(offset),
        )

    def convert(self, value: float, other: UnitDefinition) -> float:
        """A value in this unit as one in another of the same base units.

        Parameters
        ----------
        value : float
        other : UnitDefinition
        """
        if (self.factor, self.offset) == (other.factor, other.offset):
            return value  # to the last bit
        return (self.factor * value + self.offset - other.offset) / other.factor


@dataclass(frozen=True)
class Entry:
    """A value of a parameter set.

    Parameters
    ----------
    name : str
    kind : str
        ``Real``, ``Integer``, ``Boolean``, ``String``, ``Enumeration`` or ``Binary``.
    value : str
        As the file has it; for numbers the text that reads back as the same double.
    unit : str, optional
        Of a real value.
    description : str
        For a person.
    """

    name: str
    kind: str
    value: str
    unit: str | None = None
    description: str = ""


@dataclass(frozen=True)
class ParameterSet:
    """What a file holds.

    Parameters
    ----------
    name : str
    entries : sequence of Entry
    units : mapping of str to UnitDefinition
        Of the units in use.
    version : str
        Of the content, empty where there is none.
    """

    name: str
    entries: Sequence[Entry]
    units: Mapping[str, UnitDefinition] = field(default_factory=dict)
    version: str = ""

    @property
    def digest(self) -> str:
        """Hash of the values: the version of a file as built, which an edited one no longer fits."""
        text = repr([(e.name, e.kind, e.value, e.unit) for e in self.entries])
        units = repr(sorted((n, sorted(u.exponents.items()), u.factor, u.offset) for n, u in self.units.items()))
        return sha256((text + units).encode()).hexdigest()[:16]


def write_parameter_set(parameters: ParameterSet, file: str | os.PathLike[str], as_built: bool) -> None:
    """Write an SSV file of SSP 1.0, which readers of 2.0 take too.

    Parameters
    ----------
    parameters : ParameterSet
        Its version is not written.
    file : path
        An older one is replaced when the new one is whole. The same content gives the same bytes.
    as_built : bool
        Whether the values are those of the FMU; the file then carries their hash, by which `is_as_built` knows it.

    Raises
    ------
    FileError
        It cannot be written.
    """
    from lxml import etree
    from pyssp_standard.common_content_ssc import TopLevelMetaData
    from pyssp_standard.ssv import Parameter, ParameterType, SSVElem
    from pyssp_standard.unit import BaseUnit, Unit

    content = SSVElem(name=parameters.name)
    for entry in parameters.entries:
        attributes = {"value": entry.value} | ({} if entry.unit is None else {"unit": entry.unit})
        content.parameters.append(
            Parameter(name=entry.name, type_name=entry.kind, type_value=ParameterType(entry.kind, attributes))
        )
        # the library keeps what it knows of a kind and gives None to the rest
        known = content.parameters[-1]["type_value"].parameter
        content.parameters[-1]["type_value"].parameter = {k: v for k, v in known.items() if v is not None}
    for name, unit in parameters.units.items():
        numbers = {"factor": unit.factor} | ({"offset": unit.offset} if unit.offset else {})
        content.units.add_unit(Unit(name, BaseUnit(dict(unit.exponents) | numbers)))
    root = content.to_xml()
    head = TopLevelMetaData(generationTool=f"ALi3 {version('ali3')}", generationDateAndTime="")
    head.fileversion = parameters.digest if as_built else ""
    head.update_root(root)
    for element, entry in zip(root.iter("{*}Parameter"), parameters.entries, strict=True):
        if entry.description:
            element.set("description", entry.description)
    data = etree.tostring(root, pretty_print=True, encoding="UTF-8", xml_declaration=True)
    with whole_file(file) as made:
        made.write_bytes(data)


def is_as_built(file: str | os.PathLike[str]) -> bool:
    """Whether a file holds the values that a build has written; False for one that a person has changed.

    Parameters
    ----------
    file : path
    """
    try:
        parameters = read_parameter_set(file)
    except UserError:
        return False
    return parameters.version == parameters.digest


def range_words(low: float, high: float, unit: str) -> str:
    """A range for a person, empty where both ends are open.

    Parameters
    ----------
    low, high : float
        Infinite where open.
    unit : str
        "1" where there is none.
    """
    end = "" if unit == "1" else f" {unit}"
    if math.isinf(low):
        return "" if math.isinf(high) else f"up to {high:.10g}{end}"
    return f"from {low:.10g}{end}" if math.isinf(high) else f"{low:.10g} to {high:.10g}{end}"


def told(description: str, bounds: str, variability: str) -> str:
    """Description of a parameter for who edits the file: what it is, its range, and when it may change.

    Parameters
    ----------
    description : str
    bounds : str
        The range in words; empty where it is open.
    variability : str
        ``fixed`` or ``tunable``.
    """
    return "; ".join(text for text in (description, bounds, variability) if text)


def read_parameter_set(file: str | os.PathLike[str]) -> ParameterSet:
    """Read an SSV file of SSP 1.0 or 2.0, checked against the standard's XML schema.

    Parameters
    ----------
    file : path

    Returns
    -------
    ParameterSet
        Entries in the order of the file. Types of SSP 2.0 are given as those of 1.0.

    Raises
    ------
    ParameterSetError
        It is no such file; a name occurs twice; a value is a list.
    FileError
        It cannot be read.
    """
    from pyssp_standard.ssv import SSVElem

    root = _parsed(file)
    schema = _schema(root, file)
    if not schema.validate(root):
        problem = schema.error_log[0]
        raise ParameterSetError(f"{file}, line {problem.line}: {_words(problem.message)}.")
    content = SSVElem.from_xml(root)
    elements = root.iterfind("ssv:Parameters/ssv:Parameter", SSVElem.namespaces)
    entries = [
        _entry(parameter["name"], parameter["type_name"], element, f"{file}, line {element.sourceline}")
        for parameter, element in zip(content.parameters, elements, strict=True)
    ]
    _check_once((e.name for e in entries), f"{file}: the parameter", "a set gives each one once")
    units = list(root.iterfind("ssv:Units/ssc:Unit", SSVElem.namespaces))
    _check_once((u.get("name") for u in units), f"{file}: the unit", "a file defines each one once")
    definitions = {u.name: UnitDefinition.of(u.base_unit.to_dict()) for u in content.units or ()}
    for name, unit in definitions.items():
        if not (unit.factor > 0.0 and abs(unit.factor) + abs(unit.offset) < float("inf")):
            raise ParameterSetError(
                f"{file}: the unit '{name}' has the factor {unit.factor:g} and the offset {unit.offset:g}; a factor is "
                "positive, both are finite."
            )

    return ParameterSet(content.name, entries, definitions, root.get("fileversion", ""))


def _parsed(file: str | os.PathLike[str]) -> Any:
    """The root of the document; entities, which a parameter set has no use for, are refused."""
    from lxml import etree

    path = Path(file)
    if not path.exists():
        raise FileError(f"There is no parameter set {file}.")
    if not path.is_file():
        raise FileError(f"{file} is no file; a parameter set is an SSV file.")
    try:
        size = path.stat().st_size
        if size > LARGEST:
            raise ParameterSetError(f"{file} has {size} bytes; a parameter set has at most {LARGEST}.")
        data = path.read_bytes()
    except OSError as error:
        raise FileError(f"{file} cannot be read: {reason(error)}.") from None
    try:
        # the library takes a comment for an element
        parser = etree.XMLParser(resolve_entities=False, no_network=True, remove_comments=True, remove_pis=True)
        root = etree.fromstring(data, parser)
    except etree.XMLSyntaxError as error:
        raise ParameterSetError(f"{file} is no XML document: {_words(error.msg or 'it is empty')}.") from None
    if root.getroottree().docinfo.doctype:
        raise ParameterSetError(f"{file} has a document type declaration; a parameter set has none.")
    return root


def _schema(root: Any, file: object) -> Any:
    """The schema of the version that the document says it is of."""
    from lxml import etree
    from pyssp_standard.standard import ModelicaStandard

    if root.tag != f"{{{ModelicaStandard.namespaces['ssv']}}}ParameterSet":
        what = etree.QName(root).localname
        raise ParameterSetError(
            f"{file} is no SSV file: its root is '{what}' where ParameterSet of the SSP standard must be."
        )
    form = root.get("version", "")
    if form[:1] not in _SCHEMAS:
        raise ParameterSetError(f"{file} is of SSP '{form}'; 1.0 and 2.0 can be read.")
    return etree.XMLSchema(file=str(ModelicaStandard.schemas[_SCHEMAS[form[:1]]]))


def _entry(name: str, kind: str, element: Any, where: str) -> Entry:
    """An entry from its element; the library does not know the types of SSP 2.0."""
    typed = element[0]
    value = typed.get("value")
    if value is None:
        inner = [v.get("value") for v in typed.iterfind("{*}Value")]
        if len(inner) != 1:
            raise ParameterSetError(f"{where}: '{name}' has {len(inner)} values; one is needed.")
        value = inner[0]
    kind = _KINDS.get(kind, kind)
    if kind in ("Real", "Integer", "Boolean") and len(value.split()) != 1:
        raise ParameterSetError(f"{where}: '{name}' has {len(value.split())} values; one is needed.")
    if kind not in ("String", "Enumeration"):
        value = value.strip()
    return Entry(name, kind, value, typed.get("unit"), element.get("description", ""))


def _check_once(names: Iterable[str], what: str, rule: str) -> None:
    seen: set[str] = set()
    for name in names:
        if name in seen:
            raise ParameterSetError(f"{what} '{name}' occurs twice; {rule}.")
        seen.add(name)


def _words(message: str) -> str:
    """A message of the schema without namespaces, as the rest of a sentence."""
    return " ".join(re.sub(r"\{[^{}]*\}", "", message).split()).rstrip(".")
