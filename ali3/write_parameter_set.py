"""Writes parameter sets with the package `pyssp_standard`."""

import os
from importlib.metadata import version

from ali3.errors import UserError
from ali3.files import write_bytes
from ali3.parameter_set import ParameterSet
from ali3.read_parameter_set import read_parameter_set


def write_parameter_set(parameters: ParameterSet, file: str | os.PathLike[str], as_built: bool) -> None:
    """Write an SSV file of SSP 1.0, which readers of 2.0 accept too.

    Parameters
    ----------
    parameters : ParameterSet
        Its version is not written.
    file : path
        An older file is replaced when the new one is complete. The same content gives the same bytes.
    as_built : bool
        Whether the FMU has these values; the file then has their hash as version, see `is_as_built`.

    Raises
    ------
    FileError
        The file cannot be written.
    """
    data = parameter_set_bytes(parameters, as_built)
    write_bytes(file, data)


def parameter_set_bytes(parameters: ParameterSet, as_built: bool) -> bytes:
    """Content of the file that `write_parameter_set` writes."""
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
        # the library sets attributes of other types to None
        all_attributes = content.parameters[-1]["type_value"].parameter
        content.parameters[-1]["type_value"].parameter = {k: v for k, v in all_attributes.items() if v is not None}
    for name, unit in parameters.units.items():
        factors = {"factor": unit.factor} | ({"offset": unit.offset} if unit.offset else {})
        content.units.add_unit(Unit(name, BaseUnit(dict(unit.exponents) | factors)))
    root = content.to_xml()
    head = TopLevelMetaData(generationTool=f"ALi3 {version('ali3')}", generationDateAndTime="")
    head.fileversion = parameters.digest if as_built else ""
    head.update_root(root)
    for element, entry in zip(root.iter("{*}Parameter"), parameters.entries, strict=True):
        if entry.description:
            element.set("description", entry.description)
    return bytes(etree.tostring(root, pretty_print=True, encoding="UTF-8", xml_declaration=True))


def is_as_built(file: str | os.PathLike[str]) -> bool:
    """Whether a file has the values that a build has written; False if they were edited."""
    try:
        parameters = read_parameter_set(file)
    except UserError:
        return False
    return parameters.version == parameters.digest
