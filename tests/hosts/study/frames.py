"""Frames of runs in the form of `hosts.study.store.read_study`, computed by a function instead of an FMU."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

Array = NDArray[np.float64]


def frame_of(
    x: Mapping[str, Sequence[Any] | Array],
    measures: Mapping[str, Array],
    units: Mapping[str, str],
    *,
    method: str = "latin_hypercube",
    failed: Callable[[pd.DataFrame], Any] | None = None,
    manoeuvres: Sequence[str] = ("slalom",),
    log: Sequence[str] = (),
) -> pd.DataFrame:
    """A frame; with several manoeuvres the measures have a row for each."""
    points = len(next(iter(x.values())))
    count = points * len(manoeuvres)
    frame = pd.DataFrame(
        {"point": np.repeat(np.arange(points), len(manoeuvres)), "manoeuvre": list(manoeuvres) * points, "seed": 0}
    )
    frame.index.name = "index"
    for name, values in x.items():
        frame[name] = np.repeat(np.asarray(values), len(manoeuvres))
    for name, values in measures.items():
        frame[name] = np.asarray(values, dtype=float)
    frame["status"], frame["reason"], frame["missing"], frame["wall_seconds"] = "done", "", "", 0.1
    if failed is not None:
        rows = np.asarray(failed(frame))
        frame.loc[rows, "status"] = "failed"
        frame.loc[rows, "reason"] = [f"The FMU refused the step at {0.1 * k:g} s." for k in np.flatnonzero(rows)]
        frame.loc[rows, list(measures)] = np.nan
    frame.attrs = {
        "study": "trial", "units": dict(units), "parameters": {name: {"log": name in log} for name in x},
        "sampling": {"method": method}, "seed": 7, "guid": "{1234}", "model": "Car",
        "fmu": "Car.fmu", "versions": {"ali3": "0.1"}, "runs": count, "points": points, "measures": list(measures),
        "manoeuvres": list(manoeuvres), "limits": {}, "tests": [],
    }  # fmt: skip
    return frame
