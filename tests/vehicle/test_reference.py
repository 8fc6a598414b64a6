"""The JSON Schema and the reference page say what the types say, and every range catches a unit wrong by 1000."""

import copy
import functools
import json
import re

import fastjsonschema
import jsonschema
import pytest

from ali3.typed_paths import all_keys, annotation_of, keys_of, templates, value_type_of
from mbs.vehicle import Car, car_names, json_schema, load
from mbs.vehicle import quantities as listed
from mbs.vehicle.quantities import Quantity, quantities_in
from mbs.vehicle.reference import tables
from mbs.vehicle.schema import SCHEMA_FILE, schema_text


def every_table(table=Car):
    yield table
    for field in keys_of(table).values():
        named = value_type_of(field.annotation)
        for inner in templates(field.annotation if named is None else named):
            yield from every_table(inner)


TABLES = list(dict.fromkeys(every_table()))
FIELDS = {
    f"{table.__name__}.{key}": quantity
    for table in TABLES
    for key, field in keys_of(table).items()
    for quantity in quantities_in(annotation_of(field))
}
QUANTITIES = {name: quantity for name in dir(listed) for quantity in quantities_in(getattr(listed, name))}


def test_ranges_span_less_than_a_factor_of_1000():
    wrong = []
    for name, q in (QUANTITIES | FIELDS).items():
        if not (q.low < q.high or (q.zero and q.low == q.high)):  # 0 or one other value
            wrong.append(f"{name} has no range: {q.low:g} to {q.high:g}")
        if q.low > 0.0 and not q.high < 1000.0 * q.low and q.unit != "kg.m2":  # radii of gyration tell of inertias
            wrong.append(f"{name} has a range too wide: {q.low:g} to {q.high:g}")
        if q.low == 0.0:
            wrong.append(f"{name}: what may be 0 has zero=True")
        # coordinates, inertia, lift, rows, angles, compliances
        of_a_side = name in ("BrakeSide", "Brakes.side")  # left or right
        if q.low < 0.0 and not of_a_side and q.unit not in ("m", "m/s", "m2", "N", "kg.m2", "deg", "rad", "rad/N"):
            wrong.append(f"{name} in {q.unit} may be negative")
    assert not wrong, "\n".join(wrong)
    assert len(QUANTITIES) > 40
    assert len(FIELDS) > 100


def test_every_key_has_a_description():
    wrong = [table.__name__ for table in TABLES if not table.__doc__]
    for table in TABLES:
        for key, field in keys_of(table).items():
            if not re.fullmatch(r"[^.].*\.", field.description or "", re.DOTALL):
                wrong.append(f"{table.__name__}.{key}")
    assert not wrong, "\n".join(wrong)


def test_the_schema_in_the_package_is_that_of_the_types():
    assert SCHEMA_FILE.read_text(encoding="utf-8") == schema_text(), "run python -m mbs.vehicle.reference"
    jsonschema.Draft7Validator.check_schema(json_schema())


@functools.cache
def fast_validator():
    return fastjsonschema.compile(json.loads(schema_text()))


def test_two_validators_accept_the_cars_of_the_package():
    for name in car_names():
        data = copy.deepcopy(load(name)._data)  # validators write defaults into it
        jsonschema.Draft7Validator(json.loads(schema_text())).validate(data)
        fast_validator()(data)


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("front.spring.stiffness", 12.36),
        ("front.spring.stifness", 1.0),
        ("front.wheel.centre", [0.0, 0.67]),
        ("front.suspension.kind", "five_link"),
        ("schema", 3),
        ("front.tyre.grip", 0.001),
        ("chassis.accelerometers", {"a b": [0.0, 0.0, 0.2]}),
    ],
)
def test_two_validators_refuse_as_the_types_do(path, value):
    data = json.loads(json.dumps(load("prototype")._data))
    *outer, last = path.split(".")
    table = data
    for key in outer:
        table = table[key]
    table[last] = value
    assert not jsonschema.Draft7Validator(json.loads(schema_text())).is_valid(data)
    with pytest.raises(fastjsonschema.JsonSchemaException):
        fast_validator()(data)


def test_0_is_allowed_as_the_type_declares():
    schema = json.loads(schema_text())["definitions"]["TMeasy"]["properties"]["grip"]
    validator = jsonschema.Draft7Validator(schema)
    assert [validator.is_valid(value) for value in (0, 0.0, 0.01, 0.5, 11)] == [True, True, False, True, False]
    assert schema["unit"] == "1"


def test_the_page_has_every_key_range_and_parameter():
    text = tables()
    for path in all_keys(Car):
        assert f"| `{path.split('.')[-1]}` |" in text, path
    q: Quantity = FIELDS["Spring.stiffness"]
    row = next(line for line in text.splitlines() if line.startswith("| `stiffness` ") and "Spring rate" in line)
    assert all(word in row for word in (f"{q.low:g} to {q.high:g}", "N/m", "tunable"))
