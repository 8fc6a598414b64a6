"""The content of car files for tests that change it."""

import re
import warnings

from mbs.vehicle import CarFileError, load
from mbs.vehicle.car import car_from
from mbs.vehicle.changed_content import changed_content

FORBIDDEN = re.compile(r"Input should|validation error|Traceback|pydantic|Field required|Extra inputs|NoneType|\{|\}")


def leaves(data, path=()):
    """Every value of a file that is not a table or list, with its key path."""
    if isinstance(data, dict):
        for key, value in data.items():
            yield from leaves(value, (*path, str(key)))
    elif isinstance(data, (list, tuple)):
        for k, value in enumerate(data):
            yield from leaves(value, (*path, str(k)))
    else:
        yield ".".join(path), data


def tables_of(name):
    """Key path of every table of a car's file."""
    return list(tables(load(name)._data))


def tables(data, path=()):
    """Key path of every table."""
    for key, value in data.items():
        if isinstance(value, dict):
            yield ".".join((*path, key))
            yield from tables(value, (*path, key))


def numbers(name):
    """Key path and value of every number in a car's file."""
    result = leaves(load(name)._data)
    return {path: float(v) for path, v in result if isinstance(v, (int, float)) and path != "schema"}


def new_with(name, paths, names):
    """Key paths of a car that no car before it in `names` has, where suspensions differ by kind.

    `paths`: function of the name of a car.
    """
    *before, _ = names[: names.index(name) + 1]
    known = {_path_with_kind(other, path) for other in before for path in paths(other)}
    return [path for path in paths(name) if _path_with_kind(name, path) not in known]


def _path_with_kind(name, path):
    axle, _, rest = path.partition(".")
    return path, load(name)._data[axle]["suspension"]["kind"] if rest.startswith("suspension") else ""


def sentences(message, prefix):
    """Lines of a message; fails if one is not a sentence that begins with `prefix`."""
    lines = str(message).split("\n")
    assert 1 <= len(lines) <= 9
    for line in lines:
        assert line.startswith(prefix), line
        assert line[-1] in ".?", line
        assert not FORBIDDEN.search(line), line
        assert len(line) < 500, line
    return lines


def problems_of(changes, name):
    """Sentences of the error or the warnings for a car's file with changed values; empty if there are none."""
    try:
        return warnings_of(changes, name)
    except CarFileError as error:
        return sentences(error, "x: ")


def warnings_of(changes, name):
    """Sentences of the warnings for a car's file with changed values, without its frame unless a change is in it."""
    car = load(name)
    data = changed_content(car._data, changes, "x")
    if not any(path.startswith("chassis.") for path in changes):
        data["chassis"].pop("frame", None)  # its modes take long
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        car_from(data, car.folder, "x", warn=True)
    return [line for warning in caught for line in sentences(warning.message, "x: ")]
