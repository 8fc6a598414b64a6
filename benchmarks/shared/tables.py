"""Rows as aligned columns on the terminal and as JSON files."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ali3.columns import in_columns
from ali3.files import write_text


def plain_table(rows: Sequence[Mapping[str, Any]]) -> str:
    """Rows as aligned columns; what is None, or not there, is "-"."""
    keys = list(dict.fromkeys(key for row in rows for key in row))
    cells = [keys] + [[_cell(row.get(key)) for key in keys] for row in rows]
    rule = ["-" * max(map(len, column)) for column in zip(*cells, strict=True)]
    right = {k for k, key in enumerate(keys) if not isinstance(rows[0].get(key), str)}
    return "\n".join(in_columns([cells[0], rule, *cells[1:]], right))


def write_json(file: Path, meta: Mapping[str, Any], rows: Sequence[Mapping[str, Any]]) -> None:
    """Write ``{"meta": ..., "rows": [...]}``; numbers that are not finite become null."""
    text = json.dumps({"meta": _plain(meta), "rows": _plain(rows)}, indent=1, allow_nan=False)
    write_text(file, text + "\n")


def _cell(value: Any) -> str:
    if value is None:
        return "-"
    return value if isinstance(value, str) else f"{value:.4g}"


def _plain(value: Any) -> Any:
    """Values that JSON knows."""
    if isinstance(value, Mapping):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [_plain(v) for v in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not np.isfinite(value):
        return None
    return value
