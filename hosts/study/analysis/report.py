"""The report of a study: one HTML file, its plots and its table of effects."""

import shlex
from pathlib import Path

import pandas as pd
from matplotlib import pyplot as plt

from ali3.bars import bar as bar_of
from ali3.chart_style import STYLE
from ali3.charts import drawing
from ali3.files import atomic_file, make_folder, write_text
from ali3.processes import command_name
from hosts.common.errors import HostError
from hosts.experiment.report import FAINT, Plots, Section, page, paragraph
from hosts.study.analysis.data import study_data
from hosts.study.analysis.measure_section import measure_section
from hosts.study.analysis.study_section import (
    MAX_RESPONSES,
    Commands,
    facts,
    failed_sections,
    limits_section,
    measures_section,
)
from hosts.study.analysis.summary_plots import plot_correlations
from hosts.study.folder import ANALYSIS, check_no_link
from hosts.study.parts import check_signals
from hosts.study.store import read_study, study_record


def write_report(folder: Path) -> list[Path]:
    """Write ``report.html``, and its plots and the table of effects into ``analysis``.

    `folder`: folder of a study, finished or not. Returns the paths of the report and of the folder ``analysis``. Raises
    `HostError` if there is no study or no finished run, the folder has a link, or a file of rows or signals is damaged.
    """
    frame = read_study(folder)
    check_signals(folder, study_record(folder))

    def commands(index: int) -> list[str]:
        # The path is absolute, since the report may be read from any folder.
        return [f"{command_name('study')} {shlex.join([str(folder.absolute()), '--run', str(index)])}"]

    return report_of(frame, folder, commands)


def report_of(frame: pd.DataFrame, folder: Path, commands: Commands) -> list[Path]:
    """The report of a frame of runs; see `write_report`."""
    if not len(frame):
        raise HostError(f"{folder} has no run yet; there is nothing to report.")
    check_no_link(folder)
    data, plots = study_data(frame), Plots(folder / ANALYSIS)
    responses = data.responses[:MAX_RESPONSES]
    effect_rows: list[dict[str, object]] = []
    with plt.rc_context({**STYLE, "font.size": 9, "axes.titlesize": 10}):
        sections = [*limits_section(data), measures_section(data), *failed_sections(data, plots, commands)]
        if responses and data.parameters:
            message = "Spearman's: 1 or -1 where the measure only grows or only falls with it."
            correlations = plots.add(drawing(plot_correlations(data, responses), "Rank correlations"), "correlations")
            sections.append(Section("Rank correlations", [paragraph(message, FAINT), correlations]))
        for k, response in enumerate(bar_of(responses, desc="report", unit="measure")):
            sections.append(measure_section(data, response, k, plots, commands, effect_rows))
    file, effects_file = folder / "report.html", make_folder(folder / ANALYSIS) / "effects.csv"
    write_text(file, page(f"Study {data.about['study']}", facts(data), sections))
    with atomic_file(effects_file) as temporary:
        pd.DataFrame(effect_rows).to_csv(temporary, index=False)
    return [file, effects_file.parent]
