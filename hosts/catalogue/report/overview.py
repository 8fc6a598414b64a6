"""The first part of the report: tables of cars, and of all tests and measures side by side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from ali3.html_elements import Content, element, table
from ali3.units import typeset
from hosts.catalogue.car import TestedCar
from hosts.catalogue.report.numbers import NONE, difference_text, limit_element, with_unit
from hosts.catalogue.standard_test import StandardTest, TestRecord
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.fmu.fmu import described
from hosts.fmu.variables import Variables, default_step
from hosts.measures.measure import Limit, Measure

if TYPE_CHECKING:
    from lxml.html import HtmlElement


class _ValueTexts(NamedTuple):
    """A start value and the default of its variable, with units."""

    value: str
    default: str


def car_tables(cars: Sequence[TestedCar]) -> list[HtmlElement]:
    """Tables of the cars and of their changed parameters."""
    columns = [_car_column(car) for car in cars]
    rows: list[list[Content]] = [[name, *(column[name] for column in columns)] for name in columns[0]]
    elements = [table("Cars", ["", *(car.label for car in cars)], rows)]
    changed = _changed_parameter_rows(cars)
    if changed:
        caption = "Parameters that are not as built"
        elements.append(table(caption, ["parameter", *(car.label for car in cars)], changed))
    else:
        elements.append(element("p", "All parameters are as built."))
    return elements


def _car_column(car: TestedCar) -> dict[str, Content]:
    """What is known of a car, by the names of the rows; the error is the model of an FMU that cannot be read."""
    try:
        description = described(car.path)
    except HostError as error:
        return _column_of(car, str(error), NONE, NONE, NONE)
    tool = ", ".join(filter(None, (description.generationTool, description.generationDateAndTime)))
    step = with_unit(default_step(description) if car.step is None else car.step, "s")
    return _column_of(car, description.modelName or NONE, description.guid or NONE, tool or NONE, step)


def _column_of(car: TestedCar, model: str, guid: str, tool: str, step: str) -> dict[str, Content]:
    alias_count = car.fmu.count
    return {
        "file": car.path.name,
        "model": model,
        "GUID": element("code", guid),
        "made by": tool,
        "communication step": step,
        "names": f"{alias_count} by an alias file" if alias_count else "those of the FMU",
    }


def _changed_parameter_rows(cars: Sequence[TestedCar]) -> list[list[Content]]:
    """A row for each parameter that is not as built in a car, in the units of the FMU."""
    texts_by_car = [_start_texts(car) for car in cars]
    names = list(dict.fromkeys(name for texts in texts_by_car for name in texts))
    rows: list[list[Content]] = []
    for name in names:
        entries = [texts.get(name, _ValueTexts("as built", "")) for texts in texts_by_car]
        if any(entry.value not in (entry.default, "as built") for entry in entries):
            rows.append([element("code", name), *map(_changed_cell, entries)])
    return rows


def _start_texts(car: TestedCar) -> dict[str, _ValueTexts]:
    """Texts of the start values by ALi3 names; empty if the FMU cannot be read."""
    try:
        variables = Variables(described(car.path))
    except HostError:
        return {}
    texts = {}
    for name, value in car.start.items():
        ((fmu_name, fmu_value),) = car.fmu.fmu_values({name: value}).items()
        texts[name] = _value_texts(variables, fmu_name, fmu_value)
    return texts


def _changed_cell(texts: _ValueTexts) -> HtmlElement:
    has_other_default = texts.default and texts.default != texts.value
    return element("td", texts.value, element("small", f"as built {texts.default}") if has_other_default else "")


def _value_texts(variables: Variables, name: str, value: Value) -> _ValueTexts:
    if name not in variables.names:
        return _ValueTexts(str(value), "")
    variable = variables[name]
    return _ValueTexts(variable.with_unit(value), variable.with_unit(variable.start))


def overview_tables(
    tests: Sequence[StandardTest], labels: Sequence[str], records: Mapping[str, Mapping[str, TestRecord | str]]
) -> list[HtmlElement]:
    """The table of the outcomes of tests by car, and the table of all measures by car."""
    outcome_rows: list[list[Content]] = [
        [
            element("a", test.title, href=f"#{test.name}"),
            *(_outcome_cell(records.get(test.name, {}).get(label)) for label in labels),
        ]
        for test in tests
    ]
    measure_rows: list[list[Content]] = []
    for test in tests:
        results = [_displayed_measures(records.get(test.name, {}).get(label)) for label in labels]
        names = list(dict.fromkeys(name for measures in results for name in measures))
        if names:
            measure_rows.append([test.title])
        for name in names:
            measure_rows.append(_measure_row(name, [measures.get(name) for measures in results]))
    elements = [table("Tests", ["test", *labels], outcome_rows)]
    if measure_rows:
        suffix = f"; differences from {labels[0]}" if len(labels) > 1 else ""
        elements.append(table(f"Measures{suffix}", ["measure", *labels, "limit"], measure_rows))
    return elements


def _displayed_measures(record: TestRecord | str | None) -> dict[str, Measure]:
    if not isinstance(record, TestRecord):
        return {}
    return {measure.name: measure.displayed() for measure in record.measures}


def _outcome_cell(record: TestRecord | str | None) -> HtmlElement:
    if record is None:
        return element("td", "not selected")
    if isinstance(record, str):
        return element("td", "not done", element("small", record))
    note_count = len(record.notes)
    notes = f"{note_count} note{'s' if note_count > 1 else ''}" if note_count else ""
    remarks: list[Content] = [element("small", notes)] if notes else []
    limits = [measure.is_kept for measure in record.measures if measure.is_kept is not None]
    if not limits:
        return element("td", "done", *remarks)
    return element("td", limit_element(all(limits), _count_text(sum(limits), len(limits))), *remarks)


def _count_text(kept: int, limits: int) -> str:
    if kept == limits:
        return "limit kept" if limits == 1 else f"{limits} limits kept"
    return "limit not kept" if limits == 1 else f"{limits - kept} of {limits} limits not kept"


def _measure_row(name: str, measures: Sequence[Measure | None]) -> list[Content]:
    """The row of a measure; other cars are compared with the first one."""
    present = [measure for measure in measures if measure is not None]
    first = present[0]
    unit, limit = typeset(first.unit), first.limit
    has_common_note = len(present) > 1 and all(measure.note == first.note for measure in present)
    unit_text = f", {unit}" if unit else ""
    label: list[Content] = [first.text or name, element("small", f" {name}{unit_text}")]
    if has_common_note and first.note:
        label.append(element("small", f" {first.note}"))
    cells: list[Content] = [element("span", *label)]
    for k, measure in enumerate(measures):
        if measure is None:
            cells.append(element("td", NONE))
            continue
        reference = measures[0] if k else None
        cells.append(_value_cell(measure, reference, limit, "" if has_common_note else measure.note))
    cells.append("" if limit is None else element("td", limit.range_text(unit), element("small", limit.source)))
    return cells


def _value_cell(measure: Measure, reference: Measure | None, row_limit: Limit | None, note: str) -> HtmlElement:
    """The cell of a value: its limit, its difference from `reference`, and its note. `row_limit`: limit of the row."""
    content: list[Content] = [with_unit(measure.value, measure.unit)]
    limit = measure.limit
    if limit is not None:
        if measure.is_kept is not None:
            content += [" ", limit_element(measure.is_kept)]
        if limit != row_limit:
            content.append(element("small", f"here {limit.range_text(typeset(measure.unit))}"))
    if reference is not None:
        if reference.unit == measure.unit:
            text = difference_text(measure.value, reference.value)
        else:
            text = f"in {measure.unit}; the first car in {reference.unit}"
        if text:
            content.append(element("small", text))
    if note:
        content.append(element("small", note))
    return element("td", *content, class_="value", title=repr(float(measure.value)))
