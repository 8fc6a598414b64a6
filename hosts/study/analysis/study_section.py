"""Sections of the report about the whole study: runs, all measures, limits, failed runs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, TypeAlias

from ali3.charts import drawing
from ali3.html_elements import Content, table
from hosts.experiment.report import FAINT, NOTE, Plots, Section, commands_cell, paragraph
from hosts.study.analysis.data import StudyData
from hosts.study.analysis.effect_plots import plot_failed
from hosts.study.analysis.tables import messages_with_runs, reasons, reported_statistics, statistics
from hosts.study.limits import share_notes, share_rows, shares
from hosts.study.worker_data import DONE, FAILED, INCOMPLETE

MAX_RESPONSES = 40
_MAX_RUNS_OF_REASON = 3
_MAX_REASONS = 20

if TYPE_CHECKING:
    from lxml.html import HtmlElement

Commands: TypeAlias = "Callable[[int], Sequence[str]]"
"""Lines that repeat the run of an index."""


def facts(data: StudyData) -> list[HtmlElement]:
    """The table of the study, and notes on missing runs and measures without plots."""
    about, counts = data.about, data.frame["status"].astype(str).value_counts()
    message = ", ".join(f"{counts[s]} {s}" for s in (DONE, INCOMPLETE, FAILED) if s in counts)
    versions = ", ".join(f"{k} {v}" for k, v in about["versions"].items())
    sampling = about["sampling"]
    rows = [
        ("FMU", f"{about['fmu']}, model {about['model']}, GUID {about['guid']}"),
        ("manoeuvres", ", ".join(about["manoeuvres"])),
        ("sampling", f"{sampling['method']}, seed {about['seed']}"),
        ("runs", f"{len(data.frame)} of {data.planned}: {message}"),
        ("versions", versions),
    ]
    body = [table("What was run", ("", ""), rows)]
    if len(data.frame) < data.planned:
        missing = data.planned - len(data.frame)
        body.append(
            paragraph(f"{missing} of {data.planned} runs are not done yet; this is the report of the others.", NOTE)
        )
    if len(data.responses) > MAX_RESPONSES:
        remaining = len(data.responses) - MAX_RESPONSES
        body.append(
            paragraph(
                f"Plots are drawn of the first {MAX_RESPONSES} measures; {remaining} more are in the table only.", NOTE
            )
        )
    return body


def measures_section(data: StudyData) -> Section:
    """The table of all measures with their percentiles, or with their ranges where runs are not a random sample."""
    if not data.responses:
        return Section("Measures", [paragraph("No run yields a measure.", NOTE)])
    names, why = reported_statistics(data)
    all_statistics = [(r, statistics(r)) for r in data.responses]
    rows = [
        (r.label, r.unit, f"{len(r.rows)} of {r.requested}", *(f"{s[n]:.5g}" for n in names if n != "runs"))
        for r, s in all_statistics
    ]
    body = [table("Of all runs", ("measure", "unit", *names), rows, "numbers")]
    if why:
        body.append(paragraph(f"There are no percentiles: {why}.", FAINT))
    return Section("Measures", body)


def limits_section(data: StudyData) -> list[Section]:
    """The table of fractions of the runs within the limits of the study; empty if it has none."""
    share_list = shares(data.frame)
    if not share_list:
        return []
    rows = share_rows(share_list, data.about)
    message = " ".join(share_notes(share_list, data.about))
    head = ("measure", "limit", "within", "share", "95 % interval")
    return [Section("Limits", [table("Runs within the limits", head, rows, "numbers"), paragraph(message, FAINT)])]


def failed_sections(data: StudyData, plots: Plots, commands: Commands) -> list[Section]:
    """Sections on failed runs, on incomplete runs and on messages of the FMU; empty if there are none."""
    sections = []
    failed = reasons(data, FAILED)
    failed_plot: list[HtmlElement] = []
    if failed and data.parameters:
        plot = drawing(plot_failed(data), "Share of failed runs over each parameter")
        message = "Share of failed runs, Wilson's interval of 95 %; a mark below is a failed run."
        failed_plot = [plots.add(plot, "failed"), paragraph(message, FAINT)]
    for groups, title, plot_parts in (
        (failed, "Failed runs", failed_plot),
        (reasons(data, INCOMPLETE), "Runs without some measure", []),
        (messages_with_runs(data), "Messages of the FMU", []),
    ):
        if not groups:
            continue
        body = [*plot_parts]
        rows: list[tuple[Content, ...]] = []
        for text, indices in groups[:_MAX_REASONS]:
            for k, index in enumerate(indices[:_MAX_RUNS_OF_REASON]):
                first = (text, str(len(indices))) if k == 0 else ("", "")
                rows.append((*first, str(index), commands_cell(commands(index))))
        body.append(table("Words and runs", ("words", "runs", "for example", "to repeat it"), rows, "numbers"))
        if len(groups) > _MAX_REASONS:
            body.append(paragraph(f"{len(groups) - _MAX_REASONS} rarer ones are in the table of runs only.", FAINT))
        sections.append(Section(title, body))
    return sections
