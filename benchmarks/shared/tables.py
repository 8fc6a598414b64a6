"""Rows as aligned text and as JSON files; columns of numbers as CSV files with comments."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.columns import in_columns
from ali3.files import write_text


def plain_table(rows: Sequence[Mapping[str, Any]]) -> str:
    """Rows as aligned columns; a value that is None or missing is "-"."""
    keys = list(dict.fromkeys(key for row in rows for key in row))
    cells = [keys] + [[_cell(row.get(key)) for key in keys] for row in rows]
    rule = ["-" * max(map(len, column)) for column in zip(*cells, strict=True)]
    right = {k for k, key in enumerate(keys) if not isinstance(rows[0].get(key), str)}
    return "\n".join(in_columns([cells[0], rule, *cells[1:]], right))


def write_json(file: Path, meta: Mapping[str, Any], rows: Sequence[Mapping[str, Any]]) -> None:
    """Write ``{"meta": ..., "rows": [...]}``; numbers that are not finite become null."""
    text = json.dumps({"meta": _plain(meta), "rows": _plain(rows)}, indent=1, allow_nan=False)
    write_text(file, text + "\n")


def read_csv(file: Path) -> tuple[list[str], dict[str, NDArray[np.float64]]]:
    """Comment lines before the heading, and columns by name, each of shape (n,)."""
    lines = file.read_text(encoding="utf-8").splitlines()
    head = [line for line in lines if line.startswith("#")]
    values = np.array([[float(v) for v in line.split(",")] for line in lines[len(head) + 1 :]])
    return head, dict(zip(lines[len(head)].split(","), values.T, strict=True))


def write_csv(file: Path, head: Sequence[str], columns: Mapping[str, NDArray[np.float64]], digits: int) -> None:
    """Write a file for `read_csv`; `head`: comment lines; `digits`: significant digits."""
    rows = [",".join(f"{v:.{digits}g}" for v in row) for row in np.column_stack(list(columns.values()))]
    file.parent.mkdir(parents=True, exist_ok=True)
    write_text(file, "\n".join([*head, ",".join(columns), *rows]) + "\n")


def _cell(value: Any) -> str:
    if value is None:
        return "-"
    return value if isinstance(value, str) else f"{value:.4g}"


def _plain(value: Any) -> Any:
    """A value with all its items converted to types of JSON."""
    if isinstance(value, Mapping):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [_plain(v) for v in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not np.isfinite(value):
        return None
    return value
