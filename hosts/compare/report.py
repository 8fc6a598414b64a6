"""The report of a comparison: one page of HTML with its figure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ali3.charts import Drawing
from ali3.files import write_text
from ali3.html_elements import element, picture, table
from ali3.message_text import sentence_of
from ali3.units import typeset
from hosts.common.display_units import shown_in
from hosts.compare.comparison import Comparison
from hosts.compare.comparison_text import delay_sentence, signal_rows
from hosts.compare.fit_result import Fit
from hosts.compare.fit_text import FIT_COLUMNS, fit_rows, result_text
from hosts.compare.windows import Bin
from hosts.experiment.report import NOTE, PROBLEM, Section, page, paragraph

if TYPE_CHECKING:
    from lxml.html import HtmlElement

_COLUMNS = ("signal", "unit", "rms", "normalised", "mean", "largest", "at, s", "correlation", "rating",
            "corridor", "phase", "magnitude", "slope", "delay, ms")  # fmt: skip
_BIN_COLUMNS = ("signal", "unit", "where", "from, to", "samples", "rms", "mean")
_FOOTER = (
    "Deviations are simulated minus measured, at the samples of the log, with no delay taken out. Normalised: rms over "
    "the standard deviation of the measured signal. The rating is like ISO/TS 18571, by public descriptions of it, at "
    "no more than 1000 points; above 0.94 excellent, 0.80 good, 0.58 fair. Intervals are of 95 %; they take into "
    "account that neighbouring residuals are alike, and hold as far as the model can be right at all. Without it: how "
    "much more is left of parts of the log that are left out in turn if the parameter keeps its start value."
)


def write_report(
    title: str,
    before: Comparison,
    after: Comparison | None,
    fit: Fit | None,
    bins: Sequence[Bin],
    notes: Sequence[str],
    problems: Sequence[str],
    paths: Mapping[str, Path],
    figure: Drawing,
) -> None:
    """Write the page to the path ``.html``, and its figure to the path ``.svg``.

    `bins`: deviations by measured speed and lateral acceleration.
    """
    delay = delay_sentence(before)
    content: list[HtmlElement] = [_deviations_table(before)] + ([paragraph(delay)] if delay else [])
    sections = [Section("Deviations" if after is None else "Deviations before the fit", content)]
    if after is not None and fit is not None:
        sections.append(Section("Deviations with the fitted parameters and sensors", [_deviations_table(after)]))
        names = [f.unknown.name for f in fit.found]
        rows = [(n, *(f"{c:.2f}" for c in row)) for n, row in zip(names, fit.correlation.tolist(), strict=True)]
        content = [table("", FIT_COLUMNS, fit_rows(fit), "numbers")]
        content += [paragraph(sentence_of(line)) for line in result_text(fit)]
        content += [element("h3", "Correlation of the errors"), table("", ("", *names), rows, "numbers")]
        sections.append(Section("Fit", content))
    if bins:
        binned = table("", _BIN_COLUMNS, bin_rows(bins, before), "numbers")
        sections.append(Section("By speed and lateral acceleration", [binned]))
    figure.write(paths[".svg"])
    sections.append(Section("Signals", [picture(figure), *(paragraph(line, NOTE) for line in notes)]))
    facts = [paragraph(line, PROBLEM) for line in problems]
    write_text(paths[".html"], page(title, facts, sections, _FOOTER))


def bin_rows(bins: Sequence[Bin], comparison: Comparison) -> list[Sequence[str]]:
    """Rows of the table by speed and lateral acceleration, in the units of reports."""
    rows: list[Sequence[str]] = []
    for b in bins:
        unit, factor = shown_in(comparison.signals[b.signal].measured.unit, b.signal)
        scale, width = shown_in(b.unit)
        rows.append(
            [b.signal, typeset(unit), f"{b.quantity}, {typeset(scale)}", f"{width * b.low:g} to {width * b.high:g}",
             str(b.samples), f"{factor * b.rms:.4g}", f"{factor * b.mean:.4g}"]
        )  # fmt: skip
    return rows


def _deviations_table(comparison: Comparison) -> HtmlElement:
    rows = [[row[name] for name in _COLUMNS] for row in signal_rows(comparison, "–")]
    return table("", _COLUMNS, rows, "numbers")
