"""The begin of the report: tables of cars, and of all tests and measures side by side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from ali3.html_elements import Content, element, table
from ali3.units import typeset
from hosts.catalogue.car import TestedCar
from hosts.catalogue.record import StandardTest, TestRecord
from hosts.catalogue.report.numbers import NONE, difference_text, limit_element, with_unit
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.fmu.fmu import described
from hosts.fmu.variables import Variables, default_step
from hosts.measures.measure import Measure

if TYPE_CHECKING:
    from lxml.html import HtmlElement


def car_tables(cars: Sequence[TestedCar]) -> list[HtmlElement]:
    """Tables of the cars and of their changed parameters."""
    facts = [_car_facts(car) for car in cars]
    rows: list[list[Content]] = [[name, *(f[name] for f in facts)] for name in facts[0]]
    elements = [table("Cars", ["", *(car.label for car in cars)], rows)]
    changed = _changed_parameter_rows(cars)
    if changed:
        caption = "Parameters that are not as built"
        elements.append(table(caption, ["parameter", *(car.label for car in cars)], changed))
    else:
        elements.append(element("p", "All parameters are as built."))
    return elements


def _car_facts(car: TestedCar) -> dict[str, Content]:
    try:
        description = described(car.path)
    except HostError as error:
        description = None
        model, guid, tool, step = str(error), NONE, NONE, NONE
    if description is not None:
        model, guid = description.modelName or NONE, description.guid or NONE
        tool = ", ".join(filter(None, (description.generationTool, description.generationDateAndTime))) or NONE
        step = f"{with_unit(default_step(description) if car.step is None else car.step, 's')}"
    alias_count = car.fmu.count
    return {
        "file": car.path.name,
        "model": model,
        "GUID": element("code", guid),
        "made by": tool,
        "communication step": step,
        "names": f"{alias_count} by an alias file" if alias_count else "its own",
    }


def _changed_parameter_rows(cars: Sequence[TestedCar]) -> list[list[Content]]:
    """A row for each parameter that is not as built in a car, in the units of the FMU."""
    by_car: list[dict[str, tuple[str, str]]] = []
    for car in cars:
        try:
            variables = Variables(described(car.path))
        except HostError:
            by_car.append({})
            continue
        texts = {}
        for ours, value in car.start.items():
            theirs, number = next(iter(car.fmu.theirs({ours: value}).items()))
            texts[ours] = _value_texts(variables, theirs, number)
        by_car.append(texts)
    names = list(dict.fromkeys(n for texts in by_car for n in texts))
    rows: list[list[Content]] = []
    for name in names:
        entries = [texts.get(name, ("as built", "")) for texts in by_car]
        if any(text != built and text != "as built" for text, built in entries):
            cells = [
                element("td", text, element("small", f"as built {b}") if b and b != text else "") for text, b in entries
            ]
            rows.append([element("code", name), *cells])
    return rows


def _value_texts(variables: Variables, name: str, value: Value) -> tuple[str, str]:
    """A value and that as built, with units."""
    if name not in variables.names:
        return str(value), ""
    variable = variables[name]
    return variable.with_unit(value), variable.with_unit(variable.start)


def overview_tables(
    tests: Sequence[StandardTest],
    labels: Sequence[str],
    records: Mapping[str, Mapping[str, TestRecord | str]],
) -> list[HtmlElement]:
    """The table of the outcomes of tests by car, and the table of all measures by car."""
    outcome_rows: list[list[Content]] = [
        [
            element("a", test.title, href=f"#{test.name}"),
            *(_outcome_cell(records.get(test.name, {}).get(label)) for label in labels),
        ]
        for test in tests
    ]
    rows: list[list[Content]] = []
    for test in tests:
        results = [_measures(records.get(test.name, {}).get(label)) for label in labels]
        names = list(dict.fromkeys(name for measures in results for name in measures))
        if names:
            rows.append([test.title])
        for name in names:
            rows.append(_measure_row(name, [measures.get(name) for measures in results]))
    elements = [table("Tests", ["test", *labels], outcome_rows)]
    if rows:
        suffix = f"; differences to {labels[0]}" if len(labels) > 1 else ""
        elements.append(table(f"Measures{suffix}", ["measure", *labels, "limit"], rows))
    return elements


def _measures(record: TestRecord | str | None) -> dict[str, Measure]:
    return {m.name: m.displayed() for m in record.measures} if isinstance(record, TestRecord) else {}


def _outcome_cell(record: TestRecord | str | None) -> HtmlElement:
    if record is None:
        return element("td", "not asked for")
    if isinstance(record, str):
        return element("td", "not done", element("small", record))
    limited = [m for m in record.measures if m.is_kept is not None]
    notes = f"{len(record.notes)} note{'s' if len(record.notes) > 1 else ''}" if record.notes else ""
    remarks: list[Content] = [element("small", notes)] if notes else []
    if not limited:
        return element("td", "done", *remarks)
    kept_count = sum(m.is_kept is True for m in limited)
    if kept_count == len(limited):
        text = "limit kept" if kept_count == 1 else f"{kept_count} limits kept"
        return element("td", limit_element(True, text), *remarks)
    text = "limit not kept" if len(limited) == 1 else f"{len(limited) - kept_count} of {len(limited)} limits not kept"
    return element("td", limit_element(False, text), *remarks)


def _measure_row(name: str, measures: Sequence[Measure | None]) -> list[Content]:
    """The row of a measure; other cars are compared with the first one."""
    present = [m for m in measures if m is not None]
    first = present[0]
    unit = typeset(first.unit)
    shared_note = first.note if len(present) > 1 and all(m.note == first.note for m in present) else ""
    label: list[Content] = [first.text or name, element("small", f" {name}{f', {unit}' if unit else ''}")]
    if shared_note:
        label.append(element("small", f" {shared_note}"))
    cells: list[Content] = [element("span", *label)]
    for k, measure in enumerate(measures):
        if measure is None:
            cells.append(element("td", NONE))
        else:
            cells.append(_value_cell(measure, measures[0] if k else None, first, "" if shared_note else measure.note))
    limit = first.limit
    cells.append(
        "" if limit is None else element("td", limit.range_text(typeset(first.unit)), element("small", limit.source))
    )
    return cells


def _value_cell(measure: Measure, first: Measure | None, reference: Measure, note: str) -> HtmlElement:
    """The cell of a value: its limit, its difference from the first car, and its note. `reference`: for the limit."""
    content: list[Content] = [with_unit(measure.value, measure.unit)]
    limit = measure.limit
    if limit is not None:
        if measure.is_kept is not None:
            content += [" ", limit_element(measure.is_kept)]
        if limit != reference.limit:
            content.append(element("small", f"here {limit.range_text(typeset(measure.unit))}"))
    if first is not None:
        if first.unit == measure.unit:
            text = difference_text(measure.value, first.value)
        else:
            text = f"in {measure.unit}, the first in {first.unit}"
        if text:
            content.append(element("small", text))
    if note:
        content.append(element("small", note))
    return element("td", *content, class_="value", title=repr(float(measure.value)))
