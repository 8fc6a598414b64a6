"""A table that changes between two parts of a study."""

import pytest

from hosts.study.points import digest, points_of_columns


@pytest.mark.parametrize("row", [0, 500, 999])
def test_a_change_of_any_row_of_a_table_is_seen(row: int) -> None:
    values: list[float | int | bool | str] = [float(k) for k in range(1000)]
    changed = [*values[:row], values[row] + 0.5, *values[row + 1 :]]  # type: ignore[operator]
    assert digest(points_of_columns({"a": values})) == digest(points_of_columns({"a": list(values)}))
    assert digest(points_of_columns({"a": values})) != digest(points_of_columns({"a": changed}))
