"""What a study's runs say: effects, indices, distributions, worst cases, and a report of them."""

from __future__ import annotations

from pathlib import Path


def write_report(folder: Path) -> list[Path]:
    """Write the report of a study, done or half done; see `hosts.study.analysis.report.write_report`."""
    from hosts.study.analysis.report import write_report as write

    return write(folder)
