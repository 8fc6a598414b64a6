"""Shared by commands with many runs of FMUs: worker processes, the journal of results, the page of a report."""
