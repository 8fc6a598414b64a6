"""The section of the report about one test."""

from __future__ import annotations

import math
import shlex
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from ali3.html_elements import Content, element, table
from ali3.units import typeset
from hosts.catalogue.record import Standard, StandardTest, TestRecord
from hosts.catalogue.report.numbers import NONE, limit_element, with_unit
from hosts.experiment.report import FAINT, NOTE, Section, paragraph
from hosts.measures.measure import Measure

if TYPE_CHECKING:
    from lxml.html import HtmlElement

CHECKED = "text checked"
FROM_SUMMARIES = "from public summaries"
_TESTS_OPTION = "--tests"
_SETTING_OPTION = "--test-setting"


def section(
    test: StandardTest,
    records: Mapping[str, TestRecord | str],
    settings: Mapping[str, float],
    command: Sequence[str],
    plots: Sequence[HtmlElement],
) -> Section:
    """The section of a test.

    `records`: by label of the car, in the order of the cars; `command`: of the whole report; empty: unknown.
    """
    finished = {label: r for label, r in records.items() if isinstance(r, TestRecord)}
    content: list[Content] = [_standard_element(s) for s in test.standards]
    if not test.standards:
        content.append(paragraph("After no standard.", FAINT))
    for label, record in records.items():
        if isinstance(record, str):
            content.append(element("p", element("strong", f"{label}: not done. "), record, class_=NOTE))
        else:
            content += [element("p", element("strong", f"{label}: "), note, class_=NOTE) for note in record.notes]
    if plots:
        content.append(element("div", *plots, class_="plots"))
    content += [
        _measures_element(label, test.title, [m.displayed() for m in record.measures])
        for label, record in finished.items()
        if record.measures
    ]
    if test.settings:
        content.append(_settings_element(test, settings))
    if command:
        text = shlex.join(command_of_test(command, test.name))
        content.append(element("p", "This test again:"))
        content.append(element("pre", element("code", text)))
    return Section(test.title, content, test.name)


def command_of_test(command: Sequence[str], test: str) -> list[str]:
    """The command for one test, without the list of tests and without settings of other tests."""
    retained: list[str] = []
    words = iter(command)
    for word in words:
        name, equals, value = word.partition("=")
        if name not in (_TESTS_OPTION, _SETTING_OPTION):
            retained.append(word)
            continue
        value = value if equals else next(words, "")
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
    rows: list[list[Content]] = [
        [
            element("code", s.name),
            element(
                "td",
                with_unit(settings.get(s.name, s.value), s.unit),
                element("small", f"by default {with_unit(s.value, s.unit)}")
                if settings.get(s.name, s.value) != s.value
                else "",
            ),
            s.text,
        ]
        for s in test.settings
    ]
    return element(
        "details",
        element("summary", "Settings"),
        table(f"Settings of {test.title}", ["setting", "value", "what"], rows),
    )


def _measures_element(label: str, test: str, measures: Sequence[Measure]) -> HtmlElement:
    rows: list[list[Content]] = []
    for m in measures:
        state: Content = NONE
        if m.limit is not None and m.is_kept is not None:
            state = element(
                "td",
                limit_element(m.is_kept),
                element("small", f"{m.limit.range_text(typeset(m.unit))}; {m.limit.source}"),
            )
        value = NONE if math.isnan(m.value) else f"{m.value:.7g}"
        rows.append(
            [element("code", m.name), element("td", value, class_="value"), typeset(m.unit), state, m.text, m.note]
        )
    head: list[Content] = ["measure", "value", "unit", "limit", "what", "note"]
    return element(
        "details",
        element("summary", f"Measures of {label} ({len(measures)})"),
        table(f"{test}: measures of {label}", head, rows),
    )
