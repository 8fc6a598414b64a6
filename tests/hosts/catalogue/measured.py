"""Measured values of a test of the catalogue, and empty sheets."""

from typing import Any, cast

from hosts.catalogue.measure_sheet import Sheet
from hosts.catalogue.registry import read_test_file
from hosts.catalogue.standard_test import TestRecord


def values(record: TestRecord) -> dict[str, float]:
    """Numbers by the names of measures."""
    return {m.name: m.value for m in record.measures}


def sheet_of(test: str, car: Any = None, **settings: float) -> Sheet:
    """A sheet of a test on which nothing stands; settings that are not given are by default."""
    file = read_test_file(test)
    values = {s.name: s.value for s in file.settings} | settings
    return Sheet(file, cast(Any, car), values, lambda done: None)
