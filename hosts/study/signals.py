"""Signals of all runs as Zarr: one group a manoeuvre, arrays of points times samples."""

from __future__ import annotations

import inspect
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import dask.array
import numpy as np
import xarray as xr
import zarr
from numcodecs import CRC32

from ali3.errors import FileError, reason
from hosts.study.folder import SIGNALS
from hosts.study.jobs import Job
from hosts.study.parts import attributes
from hosts.study.work import Outcome, Run

_CHUNK = 4e6  # bytes of one array in a file
_MOST_POINTS = 256  # of a file


def signal_store(folder: Path, label: str) -> Path:
    """The group of a manoeuvre."""
    return folder / SIGNALS / f"{label}.zarr"


def make_store(folder: Path, job: Job, record: Mapping[str, Any]) -> None:
    """An empty group for a manoeuvre; all values are NaN."""
    store, points, units = signal_store(folder, job.label), record["points"], record["units"]
    if store.exists():
        return
    shape = (points, job.samples)
    chunks = (max(1, min(points, _MOST_POINTS, int(_CHUNK / (8 * job.samples)))), job.samples)
    nothing = dask.array.full(shape, np.nan, chunks=chunks)
    names = record["signals"]["names"]
    time = ("time", job.every * job.step * np.arange(job.samples), {"units": "s"})
    data = xr.Dataset(
        {name: (("point", "time"), nothing, {"units": units[name]}) for name in names},
        coords={"time": time, "point": ("point", np.arange(points))},
        attrs={**{k: v for k, v in attributes(record).items() if k != "units"}, "manoeuvre": job.label},
    )
    version = "zarr_format" if "zarr_format" in inspect.signature(data.to_zarr).parameters else "zarr_version"
    options: dict[str, Any] = {version: 2, "consolidated": True, "compute": False, "mode": "w"}
    try:
        building = store.with_name(f".{store.name}")
        data.to_zarr(
            building,
            encoding={name: {"_FillValue": np.nan, "chunks": chunks, "filters": [CRC32()]} for name in names},
            **options,
        )
        building.rename(store)
    except OSError as error:
        raise FileError(f"{store} cannot be written: {reason(error)}.") from None


class SignalWriter:
    """Writes the samples of runs into the groups of their manoeuvres, in any order."""

    def __init__(self, folder: Path, jobs: Sequence[Job], names: Sequence[str]) -> None:
        self._folder, self._jobs, self._names = folder, jobs, list(names)
        self._groups: dict[int, Any] = {}
        self._kept: dict[int, dict[int, Any]] = {}
        self.bytes = 0

    def add(self, run: Run, outcome: Outcome) -> None:
        """Keep samples for the next flush."""
        point, number = divmod(run.index, len(self._jobs))
        if outcome.signals is not None:
            self._kept.setdefault(number, {})[point] = outcome.signals
            self.bytes += outcome.signals.nbytes

    def flush(self) -> None:
        """Write what was kept; before the rows, so that each row that is there has its signals.

        Raises `FileError`: it cannot be written.
        """
        for number, samples in self._kept.items():
            store = signal_store(self._folder, self._jobs[number].label)
            try:
                if number not in self._groups:
                    self._groups[number] = zarr.open_group(str(store), mode="r+")
                points = np.array(sorted(samples))
                for block in np.split(points, np.flatnonzero(np.diff(points) > 1) + 1):
                    values = np.stack([samples[int(point)] for point in block])
                    for k, name in enumerate(self._names):
                        self._groups[number][name][int(block[0]) : int(block[-1]) + 1] = values[:, :, k]
            except OSError as error:
                raise FileError(f"{store} cannot be written: {reason(error)}.") from None
        self._kept.clear()
        self.bytes = 0
