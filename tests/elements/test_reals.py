"""A number of an element is declared once: its record, its names for parameters and their checks follow."""

from collections import defaultdict
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated

import pytest

from mbs import ModelError
from mbs.common.checks import not_negative, positive
from mbs.elements import EndStops, SpringDamper, fields_in_c
from mbs.elements.element import Element
from mbs.elements.integers import IntegerKind
from mbs.elements.reals import NotNegative, Pair, Real, declared, each_real, reals_of
from mbs.elements.record import ElementRecord, columns
from mbs.kernel.header.enumerations import ElementType
from mbs.tyre_files import read_tyre
from tests.arguments.elements import TYRE, USES
from tests.elements import harness
from tests.elements.harness import vectors

UNUSED = defaultdict[str, set[str]](set, SpringDamperTable={"stiffness"})  # its spring is a table
MAGIC = read_tyre(Path(__file__).parents[1] / "tyre_files" / "data" / "assumed_61.tir").tyre()
NUMBERS = USES | {
    "Tyre that leans": (replace(TYRE, camber_slip=0.05), USES["Tyre"][1]),
    "MagicTyre": (MAGIC, USES["Tyre"][1]),
}


@dataclass(frozen=True)
class Clutch:
    torque: NotNegative
    name: str = "clutch"
    widths: Annotated[Pair, Real(positive, ("inner", "outer"), "two widths")] = (1.0, 2.0)


def test_names_values_and_checks_follow_from_the_fields():
    reals = reals_of(Clutch(3.0), "the clutch")
    assert columns(reals, 7.0) == (
        (3.0, 1.0, 2.0, 7.0),
        ("torque", "widths_inner", "widths_outer"),
        (not_negative, positive, positive),
    )
    assert reals_of(Clutch(3.0), "the clutch", {"torque": 4.0})["torque"] == (4.0, not_negative)


@pytest.mark.parametrize(
    ("clutch", "sentence"),
    [
        (Clutch(-1.0), "The torque of the clutch is -1; it must not be negative"),
        (Clutch(1.0, widths=(1.0, 0.0)), "The two widths of the clutch is 0; it must be greater than zero"),
        (Clutch(1.0, widths=(1.0,)), "The two widths of the clutch has shape"),  # type: ignore[arg-type]
    ],
)
def test_a_wrong_number_is_named(clutch: Clutch, sentence: str):
    with pytest.raises(ModelError, match=sentence):
        reals_of(clutch, "the clutch")


@pytest.mark.parametrize("name", NUMBERS)
def test_every_declared_number_of_an_element_is_one_of_its_record(name: str):
    thing, use = NUMBERS[name]
    record = use(thing)
    if not isinstance(record, ElementRecord) or not isinstance(thing, Element):
        return
    actual = dict(zip(record.real_names, zip(record.real, record.real_checks, strict=False), strict=True))
    own, last = type(thing)._real_names()
    present = last and last[0] in actual
    assert {name for name in record.real_names if name in own + last} == {*own, *(last if present else ())} - UNUSED[
        name
    ]
    for key, real in declared(type(thing)).items():
        if isinstance(real, Real) and key in own:
            values = getattr(thing, key) if real.parts else (getattr(thing, key),)
            names = [f"{key}_{part}" for part in real.parts] or [key]
            if key not in ("angle_range", "signs"):  # a tyre's coefficients have other axes
                assert [actual[n] for n in names] == [(value, real.check) for value in values]


def test_numbers_of_stops_are_those_of_the_spring_that_has_them():
    stops = EndStops(0.9, 8e3, 1.1, 5e3, 0.05, 0.06, 0.01, 0.02, 1e6, 0.002, 0.3, 0.4)
    record = SpringDamper(1.0, stops=stops).record("s", vectors(3)[0])
    actual = dict(zip(record.real_names, record.real, strict=True))
    assert {key: actual[key] for key in declared(EndStops)} == {key: getattr(stops, key) for key in declared(EndStops)}


def declaring() -> list[type[Element]]:
    """The classes from which headers in C are written."""
    return [*map(fields_in_c.class_of, ElementType)]


def test_the_headers_in_c_agree_with_the_classes():
    present = {file: file.read_text(encoding="utf-8") for file in fields_in_c.FOLDER.glob("*_fields.h")}
    assert dict(fields_in_c.headers()) == present, "run: python -m mbs.elements.fields_in_c"
    assert len(present) == len(ElementType)


ELEMENTS = {name: use for name, use in NUMBERS.items() if isinstance(use[0], Element)}


@pytest.mark.parametrize("name", ELEMENTS)
def test_class_and_kernel_refuse_the_same_numbers(name: str):
    thing, use = ELEMENTS[name]
    record = use(thing)
    assert harness.Element(record, n_inputs=6).check() is None
    said_of = {key: (real, noun) for key, real, noun in each_real(type(thing))}
    for k, key in enumerate(record.real_names):
        if key not in said_of:
            continue
        real, noun = said_of[key]
        for value in (-1.0, 0.0, 0.5, 1.0, 2.0):
            try:
                refused = real.check(value, "it") != value
            except ModelError:
                refused = True
            message = harness.Element(record, n_inputs=6).with_reals({k: value}).check()
            ours = f"the {noun} of {type(thing)._noun} {fields_in_c.RANGES[real.check][1]}"
            assert (message == ours) is refused, f"{key} = {value:g}: {message}"
            if refused and isinstance(getattr(thing, key, None), float):
                with pytest.raises(ModelError, match=rf"(?i){noun} of .* is {value:g}\b"):
                    use(replace(thing, **{key: value}))


@pytest.mark.parametrize("name", ELEMENTS)
def test_the_kernel_refuses_inputs_and_roads_that_do_not_exist(name: str):
    thing, use = ELEMENTS[name]
    element = harness.Element(use(thing), n_inputs=6)
    kinds = {integer.kind for integer, _ in zip(type(thing)._integers, element.element.integer, strict=False)}
    assert ("input that does not exist" in (element.check(n_inputs=0) or "")) is (IntegerKind.INPUTS in kinds)
    assert ("road that does not exist" in (element.check(n_roads=0) or "")) is (IntegerKind.ROADS in kinds)


def test_every_number_and_every_output_has_a_unit_and_a_sentence():
    for kind in declaring():
        texts = fields_in_c.texts(kind)
        assert all(texts[field] for field in declared(kind))
        assert all(output.unit and output.description for output in kind._outputs)
