"""Random changes of a car file give a car that compiles, or sentences, and never anything else."""

import copy
import datetime
import math
import os
import re
import warnings

import jsonschema
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from pydantic import ValidationError

from mbs import compile
from mbs.vehicle import Car, CarFileError, CarWarning, car_names, load
from mbs.vehicle.car import car_from
from mbs.vehicle.schema import json_schema
from tests.vehicle.content import sentences

EXAMPLES = int(os.environ.get("CAR_FILE_EXAMPLES", "60"))
VALIDATOR = jsonschema.Draft7Validator(json_schema())
ODD_VALUES = (
    *("", "front", "1.0", "\ud800", "a\nb", True, False, 0, 0.0, -0.0, 1, -1, 10**30, 10**400, 1e308, 5e-324, math.nan),
    *(math.inf, -math.inf, [], [1.0], [[1.0]], ["a"], [0.0, 0.0, 0.0], {}, {"kind": "macpherson"}, {"x": {"y": {}}}),
    *(datetime.date(2020, 1, 1), datetime.datetime(2020, 1, 1), datetime.time(1, 2), "x" * 10_000),
)
FACTORS = st.one_of(st.sampled_from((1e3, 1e-3, -1.0, 2.0, 0.5, 10.0, 0.1, 0.9, 1.1)), st.floats(0.8, 1.25))


def places(data):
    """Every table or list of a file with each of its keys."""
    for key, value in data.items() if isinstance(data, dict) else enumerate(data):
        yield data, key
        if isinstance(value, (dict, list)):
            yield from places(value)


@st.composite
def changed_files(draw):
    """The content of a car of the package with one to four changes."""
    name = draw(st.sampled_from(car_names()))
    data = copy.deepcopy(load(name)._data)
    for _ in range(draw(st.integers(1, 4))):
        result = list(places(data))
        where, key = result[draw(st.integers(0, len(result) - 1))]
        kind = draw(st.sampled_from(("scale", "scale", "scale", "odd", "delete", "rename", "swap", "copy")))
        value = where[key]
        if kind == "scale":
            factor = draw(FACTORS)
            where[key] = scaled(value, factor)
        elif kind == "odd":
            where[key] = copy.deepcopy(draw(st.sampled_from(ODD_VALUES)))
        elif kind == "delete":
            del where[key]
        elif kind == "rename" and isinstance(where, dict):
            other_name = draw(st.sampled_from((key[:-1], key + "s", key.upper(), "front", "kind", "ä", key + ".x")))
            where[other_name] = where.pop(key)
        else:
            other, present = result[draw(st.integers(0, len(result) - 1))]
            if kind == "swap":
                where[key], other[present] = copy.deepcopy(other[present]), copy.deepcopy(value)
            else:
                other[present] = copy.deepcopy(value)
    return name, data


def scaled(value, factor):
    """All numbers in a value times a factor."""
    if isinstance(value, dict):
        return {k: scaled(v, factor) for k, v in value.items()}
    if isinstance(value, list):
        return [scaled(v, factor) for v in value]
    if isinstance(value, float):
        return factor * value
    return value


@pytest.mark.slow
@given(changed_files())
@settings(max_examples=EXAMPLES, deadline=None, derandomize=EXAMPLES <= 60, suppress_health_check=list(HealthCheck))
def test_random_changes_give_a_car_or_sentences(file):
    name, data = file
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            car = car_from(data, load(name).folder, "x", warn=True)
        except CarFileError as error:
            sentences(error, "x: ")
            return
    assert all(isinstance(warning.message, CarWarning) for warning in caught)
    for warning in caught:
        sentences(warning.message, "x: ")
    assert compile(car.model()).meta["sensors"]


@given(changed_files())
@settings(max_examples=EXAMPLES, deadline=None, derandomize=EXAMPLES <= 60, suppress_health_check=list(HealthCheck))
def test_the_json_schema_refuses_as_the_types_do(file):
    _, data = file
    assume(not re.search(r"\b(nan|inf)\b", str(data)))  # JSON has neither
    try:
        Car.model_validate(data)
    except ValidationError:
        accepted = False
    else:
        accepted = True
    assert VALIDATOR.is_valid(data) == accepted
