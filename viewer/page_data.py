"""Recordings as the JSON of a page: scenes once each, columns as compressed blocks of numbers."""

import base64
import gzip
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.scene.recording import Recording
from ali3.scene.scene_columns import pose_columns

FORMAT = "ALi3 page"
_LARGEST_FLOAT32 = 3e38


def page_data(recordings: Sequence[Recording], options: Mapping[str, Any]) -> dict[str, Any]:
    """The data that the script of the page reads.

    Result: as `json.dumps` takes it. A block of columns is the base64 of the gzip of their bytes: all first bytes of
    the numbers, then all second ones and so on, since these are alike and become small.
    """
    scenes: list[Any] = []
    runs = []
    for recording in recordings:
        if recording.scene is not None and recording.scene not in scenes:
            scenes.append(recording.scene)
        runs.append(_run(recording, None if recording.scene is None else scenes.index(recording.scene)))
    return {"format": FORMAT, "version": 1, "scenes": scenes, "runs": runs, "options": dict(options)}


def block(columns: Mapping[str, NDArray[np.float64]], kind: str) -> dict[str, Any]:
    """Columns of one kind of number.

    Parameters
    ----------
    columns : mapping of str to array of shape (n,)
    kind : str
        ``"f8"`` or ``"f4"``.
    """
    numbers = np.array(list(columns.values()), dtype=f"<{kind}").reshape(-1)
    planes = np.frombuffer(numbers.tobytes(), np.uint8).reshape(-1, numbers.itemsize).T
    packed = gzip.compress(planes.tobytes(), 6, mtime=0)
    return {"names": list(columns), "kind": kind, "data": base64.b64encode(packed).decode("ascii")}


def _run(recording: Recording, scene: int | None) -> dict[str, Any]:
    exact = set() if recording.scene is None else set(pose_columns(recording.scene))
    exact |= {name for name, values in recording.columns.items() if _large(values)}
    rough = {name: values for name, values in recording.columns.items() if name not in exact}
    fine = {name: values for name, values in recording.columns.items() if name in exact}
    return {
        "name": recording.name,
        "scene": scene,
        "count": len(recording.t),
        "time": block({"time": recording.t, "epoch": recording.epoch}, "f8"),
        "blocks": [block(columns, kind) for columns, kind in ((fine, "f8"), (rough, "f4")) if columns],
        "units": recording.units,
        "order": list(recording.columns),
        "notes": recording.notes,
        "missing": recording.missing,
    }


def _large(values: NDArray[np.float64]) -> bool:
    """Whether single precision would turn numbers into infinity."""
    with np.errstate(invalid="ignore"):
        return bool((np.abs(values[np.isfinite(values)]) > _LARGEST_FLOAT32).any())
