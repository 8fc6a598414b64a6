"""The files of a comparison: signals side by side as CSV, measures for JSON."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from ali3.files import atomic_file
from hosts.common.numbers import or_null
from hosts.compare.comparison import Comparison
from hosts.measures.measure import Measure


def write_signals(before: Comparison, after: Comparison | None, file: Path) -> None:
    """Write the signals as CSV at all times of samples; a cell is empty if a signal has no sample.

    `after`: comparison with fitted parameters. Columns: ``time [s]``, then of each signal ``NAME.measured``,
    ``NAME.simulated`` and, with fitted parameters, ``NAME.fitted``, with the unit.
    """
    times = np.unique(np.concatenate([s.measured.time for s in before.signals.values()]))
    columns: dict[str, Any] = {}
    for name, s in before.signals.items():
        columns[f"{name}.measured [{s.measured.unit}]"] = pd.Series(s.measured.values, s.measured.time)
        columns[f"{name}.simulated [{s.measured.unit}]"] = pd.Series(s.simulated(times), times)
        if after is not None:
            columns[f"{name}.fitted [{s.measured.unit}]"] = pd.Series(after.signals[name].simulated(times), times)
    with atomic_file(file) as path:
        pd.DataFrame(columns, times).to_csv(path, index_label="time [s]", lineterminator="\r\n")


def measure_records(measures: Sequence[Measure]) -> list[dict[str, Any]]:
    """Measures for JSON, which has no NaN."""
    return [
        {"name": m.name, "value": or_null(m.value), "unit": m.unit, "text": m.text, "note": m.note} for m in measures
    ]
