"""Reads the model description of an FMU, after checking its size, depth and number of variables against limits."""

import math
from pathlib import Path
from typing import NoReturn
from xml.parsers import expat

from fmpy import read_model_description
from fmpy.model_description import ModelDescription, ScalarVariable

from ali3.archives import Archive
from ali3.limits import VARIABLE, at_most, raised
from ali3.message_text import one_line
from ali3.processes import command_name
from ali3.reading import DEEPEST, is_file, missing_file_text
from ali3.xml_memory import is_lack_of_memory
from hosts.common.errors import HostError
from hosts.fmu.scalars import ELEMENTS, Scalar, element_names, scalar_variables

DESCRIPTION = "modelDescription.xml"
MAX_DESCRIPTION_SIZE = 100_000_000
"""Largest size of the description, bytes."""
MAX_VARIABLES = 200_000
"""Largest number of scalar variables."""
_MAX_ELEMENTS = 20 * MAX_VARIABLES
_DEPTH_OF_VARIABLES = 3


def opened(path: Path) -> Archive:
    """Open an FMU as an archive. Raises `HostError` if the file does not exist, or has a fault of `ali3.archives`."""
    if not is_file(path):
        hint = f" Build it with: {command_name('build')}" if path.parent.name == "dist" else ""
        raise HostError(missing_file_text(path, hint))
    return Archive(path, HostError, kind="an FMU")


def read_description(
    path: Path, validate: bool = True
) -> tuple[ModelDescription, list[ScalarVariable], dict[str, Scalar]]:
    """Read the description of an FMU of any version that FMPy reads.

    `validate`: whether it must follow its schema. Raises `HostError` if the FMU cannot be read, or exceeds a limit.

    Returns
    -------
    description : ModelDescription
    variables : list of ScalarVariable
        Scalar variables; each element of an array is one.
    addresses : dict of str to Scalar
        Variable and index of each scalar, by name.
    """
    with opened(path) as archive:
        content = archive.read(DESCRIPTION, MAX_DESCRIPTION_SIZE)
        elements = archive.read(ELEMENTS, MAX_DESCRIPTION_SIZE) if ELEMENTS in archive else b""
    limit_check = _LimitCheck(path)
    limit_check.check(content)
    try:
        description = read_model_description(str(path), validate=validate)
        for v in description.modelVariables:  # FMPy does not read this attribute
            v.intermediateUpdate = str(v.valueReference) in limit_check.intermediate_inputs
        count = sum(math.prod(v.shape or ()) for v in description.modelVariables)
        if count > raised(MAX_VARIABLES):
            raise HostError(_too_many(path, count))
        return description, *scalar_variables(description, element_names(elements.decode()))
    except (ImportError, MemoryError, HostError):
        raise
    except Exception as error:  # FMPy does not document what a malformed description raises
        if is_lack_of_memory(error):
            raise MemoryError from None
        message = " ".join(str(error).split()) or type(error).__name__
        raise HostError(f"{path} is not an FMU that can be read: {one_line(message)}") from None


def _too_many(path: Path, count: int) -> str:
    limit = at_most(count, MAX_VARIABLES)
    return f"{path} has {count} variables, the elements of arrays counted; it must have {limit}."


class _LimitCheck:
    """Counts the elements of a description without storing them, and refuses a description beyond a limit."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self.intermediate_inputs: set[str] = set()
        """Value references of variables with ``intermediateUpdate``."""
        self._depth = self._elements = self._variables = 0
        self._most_variables, self._most_elements = raised(MAX_VARIABLES), raised(_MAX_ELEMENTS)
        self._parser = expat.ParserCreate()
        self._parser.StartElementHandler = self._begin
        self._parser.EndElementHandler = self._end
        self._parser.StartDoctypeDeclHandler = self._doctype

    def check(self, content: bytes) -> None:
        """Raises `HostError` if the content is not XML, is nested too deep, or has too many elements."""
        try:
            self._parser.Parse(content, True)
        except expat.ExpatError as error:
            self._refuse(f"is not readable XML ({error})")
        except (ValueError, LookupError) as error:
            self._refuse(f"is in an encoding that is not read ({one_line(str(error))})")

    def _begin(self, name: str, attributes: dict[str, str]) -> None:
        if not self._elements and (name != "fmiModelDescription" or "fmiVersion" not in attributes):
            self._refuse(f"begins with <{one_line(name, 60)}>; it must begin with <fmiModelDescription fmiVersion=...>")
        self._depth += 1
        self._elements += 1
        self._variables += "valueReference" in attributes and self._depth == _DEPTH_OF_VARIABLES
        if attributes.get("intermediateUpdate") in ("true", "1"):
            self.intermediate_inputs.add(attributes.get("valueReference", ""))
        if self._depth > DEEPEST:
            self._refuse(f"has elements nested more than {DEEPEST} deep")
        if self._variables > self._most_variables:
            self._refuse(f"has more than {self._most_variables} variables; {VARIABLE} raises limits")
        if self._elements > self._most_elements:
            self._refuse(f"has more than {self._most_elements} elements; {VARIABLE} raises limits")

    def _end(self, name: str) -> None:
        self._depth -= 1

    def _doctype(self, *_: object) -> None:
        self._refuse("has a document type, which may name other files; it must have none")

    def _refuse(self, words: str) -> NoReturn:
        raise HostError(f"{DESCRIPTION} of {self._path} {words}.") from None
