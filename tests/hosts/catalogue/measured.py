"""What a test of the catalogue has measured."""

from __future__ import annotations

from hosts.catalogue.record import TestRecord


def values(record: TestRecord) -> dict[str, float]:
    """Numbers by the names of measures."""
    return {m.name: m.value for m in record.measures}
