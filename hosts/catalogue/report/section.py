"""The section of the report about one test."""

from __future__ import annotations

import math
import shlex
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from ali3.html_elements import Content, element, table
from ali3.units import typeset
from hosts.catalogue.report.numbers import NONE, limit_element, with_unit
from hosts.catalogue.standard_test import Setting, Standard, StandardTest, TestRecord
from hosts.experiment.report import FAINT, NOTE, Section, paragraph
from hosts.measures.measure import Measure

if TYPE_CHECKING:
    from lxml.html import HtmlElement

CHECKED = "text checked"
FROM_SUMMARIES = "from public summaries"
_TESTS_OPTION = "--tests"
_SETTING_OPTION = "--test-setting"
_DIGITS = 7


def make_section(
    test: StandardTest,
    records: Mapping[str, TestRecord | str],
    settings: Mapping[str, float],
    command: Sequence[str],
    plots: Sequence[HtmlElement],
) -> Section:
    """Make the section of a test.

    `records`: one per car, by its label; `settings`: values of the settings of the test, by name, those missing are the
    default; `command`: command of the whole report, empty if unknown.
    """
    finished = {label: record for label, record in records.items() if isinstance(record, TestRecord)}
    content: list[Content] = [_standard_element(standard) for standard in test.standards]
    if not test.standards:
        content.append(paragraph("Not from a standard.", FAINT))
    for label, record in records.items():
        if isinstance(record, str):
            content.append(element("p", element("strong", f"{label}: not done. "), record, class_=NOTE))
        else:
            content += [element("p", element("strong", f"{label}: "), note, class_=NOTE) for note in record.notes]
    if plots:
        content.append(element("div", *plots, class_="plots"))
    content += [
        _measures_element(label, test.title, [measure.displayed() for measure in record.measures])
        for label, record in finished.items()
        if record.measures
    ]
    if test.settings:
        content.append(_settings_element(test, settings))
    if command:
        text = shlex.join(command_of_test(command, test.name))
        content.append(element("p", "Command that repeats this test:"))
        content.append(element("pre", element("code", text)))
    return Section(test.title, content, test.name)


def command_of_test(command: Sequence[str], test: str) -> list[str]:
    """The command for one test, without the list of tests and without settings of other tests."""
    retained: list[str] = []
    words = iter(command)
    for word in words:
        name, separator, value = word.partition("=")
        if name not in (_TESTS_OPTION, _SETTING_OPTION):
            retained.append(word)
            continue
        value = value if separator else next(words, "")
        if name == _SETTING_OPTION and value.startswith(f"{test}."):
            retained += [_SETTING_OPTION, value]
    return [*retained, _TESTS_OPTION, test]


def _standard_element(standard: Standard) -> HtmlElement:
    if not standard.clauses:
        return element("p", element("strong", standard.name), f", {standard.title} ({FROM_SUMMARIES})")
    clauses = [
        element(
            "li",
            f"{clause.number}: " if clause.number else "",
            clause.text,
            " ",
            element("em", f"({CHECKED if clause.checked else FROM_SUMMARIES})"),
        )
        for clause in standard.clauses
    ]
    return element(
        "div", element("p", element("strong", standard.name), f", {standard.title}"), element("ul", *clauses)
    )


def _settings_element(test: StandardTest, settings: Mapping[str, float]) -> HtmlElement:
    rows = [_setting_row(setting, settings.get(setting.name, setting.value)) for setting in test.settings]
    return element(
        "details",
        element("summary", "Settings"),
        table(f"Settings of {test.title}", ["setting", "value", "what"], rows),
    )


def _setting_row(setting: Setting, value: float) -> list[Content]:
    content: list[Content] = [with_unit(value, setting.unit)]
    if value != setting.value:
        content.append(element("small", f"by default {with_unit(setting.value, setting.unit)}"))
    return [element("code", setting.name), element("td", *content), setting.text]


def _measures_element(label: str, test: str, measures: Sequence[Measure]) -> HtmlElement:
    rows = [_measure_row(measure) for measure in measures]
    head: list[Content] = ["measure", "value", "unit", "limit", "what", "note"]
    return element(
        "details",
        element("summary", f"Measures of {label} ({len(measures)})"),
        table(f"{test}: measures of {label}", head, rows),
    )


def _measure_row(measure: Measure) -> list[Content]:
    limit_cell: Content = NONE
    if measure.limit is not None and measure.is_kept is not None:
        limit_text = f"{measure.limit.range_text(typeset(measure.unit))}; {measure.limit.source}"
        limit_cell = element("td", limit_element(measure.is_kept), element("small", limit_text))
    value = NONE if math.isnan(measure.value) else f"{measure.value:.{_DIGITS}g}"
    value_cell = element("td", value, class_="value")
    return [element("code", measure.name), value_cell, typeset(measure.unit), limit_cell, measure.text, measure.note]
