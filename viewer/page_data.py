"""Encodes recordings as JSON of a page: each scene once, columns as compressed blocks of numbers."""

import base64
import gzip
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.scene.recording import Recording
from ali3.scene.scene_columns import pose_columns

FORMAT = "ALi3 page"
_MAX_FLOAT32 = 3e38


def page_data(recordings: Sequence[Recording], options: Mapping[str, Any]) -> dict[str, Any]:
    """The data of a page for `json.dumps`.

    A block of columns is the base64 of the gzip of their bytes: first all first bytes of the numbers, then all second
    bytes and so on, which are similar and therefore compress well.
    """
    scenes: list[Any] = []
    runs = []
    for recording in recordings:
        if recording.scene is not None and recording.scene not in scenes:
            scenes.append(recording.scene)
        runs.append(_run(recording, None if recording.scene is None else scenes.index(recording.scene)))
    return {"format": FORMAT, "version": 1, "scenes": scenes, "runs": runs, "options": dict(options)}


def block(columns: Mapping[str, NDArray[np.float64]], kind: str) -> dict[str, Any]:
    """A block of columns, each of shape (n,), as numbers of the type `kind`: ``"f8"`` or ``"f4"``."""
    numbers = np.array(list(columns.values()), dtype=f"<{kind}").reshape(-1)
    planes = np.frombuffer(numbers.tobytes(), np.uint8).reshape(-1, numbers.itemsize).T
    packed = gzip.compress(planes.tobytes(), 6, mtime=0)
    return {"names": list(columns), "kind": kind, "data": base64.b64encode(packed).decode("ascii")}


def _run(recording: Recording, scene: int | None) -> dict[str, Any]:
    double_names = set() if recording.scene is None else set(pose_columns(recording.scene))
    double_names |= {name for name, values in recording.columns.items() if _exceeds_float32(values)}
    single_columns = {name: values for name, values in recording.columns.items() if name not in double_names}
    double_columns = {name: values for name, values in recording.columns.items() if name in double_names}
    return {
        "name": recording.name,
        "scene": scene,
        "count": len(recording.t),
        "time": block({"time": recording.t, "epoch": recording.epoch}, "f8"),
        "blocks": [
            block(columns, kind) for columns, kind in ((double_columns, "f8"), (single_columns, "f4")) if columns
        ],
        "units": recording.units,
        "order": list(recording.columns),
        "notes": recording.notes,
        "missing": recording.missing,
        "constants": recording.constants,
    }


def _exceeds_float32(values: NDArray[np.float64]) -> bool:
    """Whether numbers are too large for single precision."""
    with np.errstate(invalid="ignore"):
        return bool((np.abs(values[np.isfinite(values)]) > _MAX_FLOAT32).any())
