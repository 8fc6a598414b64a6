"""Reads a car file: every fault is one sentence with the file, the key path, the value and what would be right."""

from __future__ import annotations

import difflib
import sys
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any, get_args

from pydantic import ValidationError

from mbs.checks import shown
from mbs.errors import ModelError
from mbs.vehicle.car import SCHEMA, Car
from mbs.vehicle.plausible import implausible
from mbs.vehicle.section import Section

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

FILE = "car.toml"
CARS = Path(__file__).parent / "cars"
MOST_FAULTS = 8
LARGEST = 1_000_000  # bytes; the tables of a car beside it are not in the file


class CarFileError(ModelError):
    """A car file that cannot be read or does not describe a car; the message is for the user."""


def car_names() -> list[str]:
    """Names of the cars that come with the package."""
    return sorted(file.parent.name for file in CARS.glob(f"*/{FILE}"))


def load(car: str | Path) -> Car:
    """Read a car.

    Parameters
    ----------
    car : str or Path
        Name of a car of the package, a folder with a file car.toml, or such a file.

    Returns
    -------
    Car
        Checked; its `model` gives the model.

    Raises
    ------
    CarFileError
        There is no such car, or its file is not right; the message has a sentence for each fault.
    """
    if isinstance(car, str) and car in car_names():
        return _of_package(car)
    if not isinstance(car, (str, Path)):
        raise CarFileError(f"A car is the name of one, a folder or a file, not {shown(car)}.")
    path = Path(car)
    if path.is_dir():
        path = path / FILE
    if not path.is_file():
        known = ", ".join(car_names())
        raise CarFileError(f"There is no car '{car}': no file {path}, and the cars of the package are {known}.")
    return _read(path)


@cache
def _of_package(name: str) -> Car:
    return _read(CARS / name / FILE)


def _read(path: Path) -> Car:
    try:
        size = path.stat().st_size
        if size > LARGEST:
            raise CarFileError(f"{path} has {size} bytes; a car file has at most {LARGEST}.")
        text = path.read_bytes().decode("utf-8")
    except OSError as error:
        raise CarFileError(f"{path} cannot be read: {error.strerror}.") from error
    except UnicodeDecodeError as error:
        raise CarFileError(f"{path} is no text in UTF-8: byte {error.start} is not.") from error
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise CarFileError(f"{path} is no TOML file: {error}.") from error
    return car_from(data, path.parent, str(path))


def car_from(data: Mapping[str, Any], folder: Path, what: str) -> Car:
    """The car that the content of a file describes.

    Parameters
    ----------
    data : mapping
        Tables of the file.
    folder : Path
        Where its tables lie.
    what : str
        How messages call it.

    Raises
    ------
    CarFileError
        It does not describe a car.
    """
    version = data.get("schema")
    if isinstance(version, int) and not isinstance(version, bool) and version != SCHEMA:
        age = "older" if version < SCHEMA else "newer"
        raise CarFileError(
            f"{what}: schema is {version}; this release reads {SCHEMA}. The file is of an {age} form"
            + (": see docs/your_own_car.md for what changed." if version < SCHEMA else ": update ALi3.")
        )
    try:
        car = Car.model_validate(data)
    except ValidationError as error:
        raise CarFileError(_told(what, list(dict.fromkeys(_sentences(error, data))))) from None
    car.locate("")
    car._folder = folder
    car._data = dict(data)
    faults = list(implausible(car))
    if not faults and car.chassis.frame is not None:
        try:
            car.chassis.frame.check(folder)
        except ModelError as error:
            faults.append(str(error))
    if faults:
        raise CarFileError(_told(what, faults))
    return car


def _told(what: str, faults: Sequence[str]) -> str:
    shown_ones = [f"{what}: {fault}" for fault in faults[:MOST_FAULTS]]
    if len(faults) > MOST_FAULTS:
        shown_ones.append(f"{what}: {len(faults) - MOST_FAULTS} more faults.")
    return "\n".join(shown_ones)


def _sentences(error: ValidationError, data: Mapping[str, Any]) -> Iterator[str]:
    for item in error.errors(include_url=False):
        yield _sentence(_path(item["loc"], data), item)


def _path(loc: Sequence[int | str], data: Any) -> list[str]:
    """Key path of an error, without the names of templates that stand in it."""
    path: list[str] = []
    here, template = data, None  # the table whose template was named last
    for part in loc:
        if isinstance(here, Mapping) and part == here.get("kind") and here is not template:
            template = here
        elif isinstance(here, Mapping) and part in here:
            path.append(str(part))
            here = here[part]
        elif isinstance(here, (list, tuple)) and isinstance(part, int):
            path.append(str(part))
            here = here[part] if part < len(here) else None
        elif isinstance(here, Mapping):
            path.append(str(part))
            here = None
    return path


def _sentence(path: Sequence[str], item: Any) -> str:
    key, kind, context = ".".join(path) or "the file", item["type"], item.get("ctx", {})
    given = shown(item["input"])
    if kind == "missing":
        return f"{key} is missing{_wanted(path)}."
    if kind == "extra_forbidden":
        near = difflib.get_close_matches(path[-1], _names(path[:-1]), 1, 0.5)
        known = f"did you mean '{near[0]}'?" if near else f"known are {', '.join(_names(path[:-1]))}."
        return f"{key} is not known; {known}"
    if kind == "quantity":
        return f"{key} is {given}; it must be {context['range']}."
    if kind == "float_type":
        return f"{key} is {given}; it must be a number{_wanted(path)}."
    if kind in ("union_tag_invalid", "literal_error"):
        where = key if kind == "literal_error" else f"{key}.kind"
        value = given if kind == "literal_error" else shown(context["tag"])
        return f"{where} is {value}; it must be {context.get('expected_tags', context.get('expected'))}."
    if kind == "union_tag_not_found":
        return f"{key}.kind is missing; it names the template."
    if kind in ("model_type", "dict_type", "model_attributes_type"):
        return f"{key} is {given}; it must be a table."
    message = item["msg"]
    return f"{key} is {given}: {message[0].lower()}{message[1:]}."


def _wanted(path: Sequence[str]) -> str:
    """What a field is, for a message; empty where it is no field of a table."""
    table = section_type(path[:-1])
    field = next((n for n, f in table.model_fields.items() if path[-1] in (n, f.alias)), None) if table else None
    if table is None or field is None:
        return ""
    quantity, text = table.quantity(field), (table.model_fields[field].description or "").rstrip(".")
    return f": {text[:1].lower()}{text[1:]}" + (f", {quantity.range}" if quantity else "")


def _names(path: Sequence[str]) -> list[str]:
    table = section_type(path)
    return [f.alias or n for n, f in table.model_fields.items()] if table else []


def section_type(path: Sequence[str], kind: str | None = None) -> type[Section] | None:
    """Type of the table at a key path; None where there is none.

    Parameters
    ----------
    path : sequence of str
        Keys from the top of the file.
    kind : str, optional
        The template, where there are several for that place; without it the one that has the next key.
    """
    tables: list[type[Section]] = [Car]
    for part in path:
        found = [table.model_fields[part].annotation for table in tables if part in table.model_fields]
        if found:
            tables = [t for annotation in found for t in _section_types(annotation)]
        elif not tables:
            return None
    named = [t for t in tables if kind is None or "kind" not in t.model_fields or kind in _kinds(t)]
    return named[0] if named else None


def _section_types(annotation: Any) -> list[type[Section]]:
    if isinstance(annotation, type) and issubclass(annotation, Section):
        return [annotation]
    return [t for inner in get_args(annotation) for t in _section_types(inner)]


def _kinds(table: type[Section]) -> tuple[str, ...]:
    return get_args(table.model_fields["kind"].annotation)
