"""The report of standard tests: one HTML file with everything in it."""

from hosts.catalogue.report.write import write_report

__all__ = ["write_report"]
