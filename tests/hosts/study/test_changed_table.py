"""A table that changes between two halves of a study."""

from __future__ import annotations

import pytest

from hosts.study.points import digest
from hosts.study.table_points import TablePoints


@pytest.mark.parametrize("row", [0, 500, 999])
def test_a_change_of_any_row_of_a_table_is_seen(row: int) -> None:
    values: list[float | int | bool | str] = [float(k) for k in range(1000)]
    changed = [*values[:row], values[row] + 0.5, *values[row + 1 :]]  # type: ignore[operator]
    assert digest(TablePoints({"a": values})) == digest(TablePoints({"a": list(values)}))
    assert digest(TablePoints({"a": values})) != digest(TablePoints({"a": changed}))
