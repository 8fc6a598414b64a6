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
    """Key paths of a car, by a function of its name, that none of the names before it has: a suspension by its kind."""
    *before, _ = names[: names.index(name) + 1]
    known = {_place(other, path) for other in before for path in paths(other)}
    return [path for path in paths(name) if _place(name, path) not in known]


def _place(name, path):
    axle, _, rest = path.partition(".")
    return path, load(name)._data[axle]["suspension"]["kind"] if rest.startswith("suspension") else ""


def sentences(message, what):
    """The lines of an error, each a sentence for people."""
    lines = str(message).split("\n")
    assert 1 <= len(lines) <= 9
    for line in lines:
        assert line.startswith(what), line
        assert line[-1] in ".?", line
        assert not FORBIDDEN.search(line), line
        assert len(line) < 500, line
    return lines


def told(changes, name):
    """Sentences of the error or of the warnings for a car's file with other values; none: it is accepted in silence."""
    try:
        return warned(changes, name)
    except CarFileError as error:
        return sentences(error, "x: ")


def warned(changes, name):
    """Sentences of the warnings for a car's file with other values, without a frame that they do not concern."""
    car = load(name)
    data = changed_content(car._data, changes, "x")
    if not any(path.startswith("chassis.") for path in changes):
        data["chassis"].pop("frame", None)  # its modes take long
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        car_from(data, car.folder, "x", warn=True)
    return [line for warning in caught for line in sentences(warning.message, "x: ")]
