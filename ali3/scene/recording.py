"""A recording of a run: scene, times and named columns, checked, and thinned for a page."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ali3.scene.decimation import chosen_times, interpolation_error_text
from ali3.scene.errors import ViewerError
from ali3.scene.scene import check_scene, plain_scene
from ali3.scene.scene_columns import drawable, pose_columns

MAX_TIMES = 5001  # 10 s in steps of 2 ms
_FULL_TURN = 2.0 * np.pi
_MAX_NAMED = 4  # columns with the same gaps that a note names
_MAX_POSE = 1e30  # coordinate; pictures and glTF have floats of 32 bits


class Recording:
    """The recording of a run: scene, times and named columns.

    Parameters
    ----------
    scene : mapping, optional
        Scene in the format of `viewer/scene.schema.json`. Without one there are plots only.
    t : array of shape (n,)
        Times, s, not decreasing; a time that stands twice is a step.
    columns : mapping of str to array of shape (n,)
        Numbers over time, by name.
    units : mapping of str to str, optional
        Units of the columns.
    name : str
        Name of the run; by default the name of the scene.
    epoch : array of shape (n,), optional
        Whole numbers, another one where the motion begins anew, as at a reset: nothing is drawn from one to the next.
        By default it is one motion.

    Attributes
    ----------
    scene : dict or None
        None if the columns have none of its poses, which `notes` tell. Otherwise with what can be drawn: a part whose
        columns are missing or hold no number is taken out and stands in `missing`.
    missing : list of dict
        ``name`` and ``why`` of what is not drawn.
    notes : list of str
        Sentences on what the reader of the page should know: gaps, thinning.
    constants : dict
        Numbers that stayed the same, by name, such as the friction of tyres; who knows them puts them in.

    Raises
    ------
    SceneError
        The scene is not of the format.
    ViewerError
        Times or columns are not what they must be; one sentence with the name and the value.
    """

    def __init__(
        self,
        scene: Mapping[str, Any] | None,
        t: ArrayLike,
        columns: Mapping[str, ArrayLike],
        units: Mapping[str, str] | None = None,
        name: str = "",
        epoch: ArrayLike | None = None,
    ) -> None:
        if scene is not None:
            check_scene(scene)
        self.name = name or (str(scene["name"]) if scene is not None else "run")
        self.t = _times(t, self.name)
        self.epoch = np.zeros(len(self.t)) if epoch is None else _column("epoch", epoch, len(self.t))
        self.columns = {str(key): _column(str(key), values, len(self.t)) for key, values in columns.items()}
        self.units = {key: str((units or {}).get(key, "")) for key in self.columns}
        self.scene: dict[str, Any] | None = None
        self.missing: list[dict[str, str]] = []
        self.notes: list[str] = []
        self.constants: dict[str, float] = {}
        if scene is None:
            self._note_gaps(self.columns)
        else:
            self._set_scene(plain_scene(scene))

    def thinned(self, most: int = MAX_TIMES) -> Recording:
        """This recording with at most `most` times, uniform in time.

        Parameters
        ----------
        most : int
            Largest number of times, 2 or more.

        Returns
        -------
        Recording
            This one, if it has no more. Its `notes` say how many of how many times there are and, where that matters,
            by how much a pose between them differs from the recorded one.

        Raises
        ------
        ViewerError
            `most` is not a whole number of 2 or more.
        """
        if not isinstance(most, (int, np.integer)) or isinstance(most, bool) or most < 2:
            raise ViewerError(f"A recording was to be thinned to {most} times; it must be a whole number of 2 or more.")
        count = len(self.t)
        if count <= most:
            return self
        indices = chosen_times(self.t, int(most), self.epoch)
        shorter = object.__new__(Recording)
        shorter.name, shorter.scene, shorter.units, shorter.missing = self.name, self.scene, self.units, self.missing
        shorter.t, shorter.epoch, shorter.constants = self.t[indices], self.epoch[indices], self.constants
        shorter.columns = {name: values[indices] for name, values in self.columns.items()}
        span = float(self.t[-1] - self.t[0])
        note = f"{len(indices)} of {count} times are shown, one every {span / (len(indices) - 1):.2g} s."
        if self.scene is not None:
            note += interpolation_error_text(self.scene, self.t, self.columns, indices, self.epoch)
        shorter.notes = [*self.notes, note]
        return shorter

    def between(self, begin: float, end: float) -> Recording:
        """The part of this recording from one time to another.

        Parameters
        ----------
        begin, end : float
            First and last time, s.

        Raises
        ------
        ViewerError
            There is no recorded time between them.
        """
        is_between = (self.t >= begin) & (self.t <= end)
        if not is_between.any():
            raise ViewerError(
                f"There is no time from {begin:g} s to {end:g} s in {self.name!r}; it was recorded from "
                f"{self.t[0]:g} s to {self.t[-1]:g} s."
            )
        section = object.__new__(Recording)
        section.__dict__ |= self.__dict__ | {
            "t": self.t[is_between],
            "epoch": self.epoch[is_between],
            "columns": {name: values[is_between] for name, values in self.columns.items()},
            "notes": list(self.notes),
        }
        return section

    def __repr__(self) -> str:
        span = f"{len(self.t)} times from {self.t[0]:g} s to {self.t[-1]:g} s"
        notes_text = "".join(f"\n  {note}" for note in self.notes)
        notes_text += "".join(f"\n  not drawn: {item['name']}: {item['why']}" for item in self.missing)
        return f"Recording({self.name!r}, {span}, {len(self.columns)} columns){notes_text}"

    def _set_scene(self, scene: dict[str, Any]) -> None:
        """Set the scene without parts whose columns are missing, and note which."""
        needed_columns = pose_columns(scene)
        if needed_columns and not any(name in self.columns for name in needed_columns):
            self.notes.append(
                f"{scene['name']} is not drawn: the result has none of its poses, such as the column "
                f"'{needed_columns[0]}'; its signals can be plotted."
            )
            self._note_gaps(self.columns)
            return
        for name in needed_columns:
            self._remove_large_values(name)
        empty = {name for name in needed_columns if name in self.columns and not _has_finite_value(self.columns[name])}

        def column_fault(name: str) -> str | None:
            if name not in self.columns:
                return f"the result has no column '{name}'"
            return f"the column '{name}' holds no number" if name in empty else None

        drawable_scene, reasons = drawable(scene, column_fault)
        self.missing = [dict(item) for item in scene.get("missing", [])]
        self.missing += [{"name": name, "why": reason} for name, reason in reasons.items()]
        frames = {key: self._with_start(frame) for key, frame in drawable_scene["frames"].items()}
        self.scene = drawable_scene | {"frames": frames, "missing": self.missing}
        self._note_gaps(name for name in pose_columns(drawable_scene))
        for frame in drawable_scene["frames"].values():
            if "angle" in frame:
                self._unwrap(frame["angle"])

    def _with_start(self, frame: dict[str, Any]) -> dict[str, Any]:
        """A frame with a pose as drawn: the pose in the scene, otherwise the first recorded one."""
        if "start" in frame or "position" not in frame:
            return frame
        names = [*frame["position"], *frame["quaternion"]]
        is_finite = np.logical_and.reduce([np.isfinite(self.columns[name]) for name in names])
        if not is_finite.any():
            return frame
        first_pose = [float(self.columns[name][is_finite.argmax()]) for name in names]
        return frame | {"start": [first_pose[:3], first_pose[3:]]}

    def _note_gaps(self, names: Any) -> None:
        gaps: dict[bytes, list[str]] = {}
        for name in names:
            if (is_gap := ~np.isfinite(self.columns[name])).any():
                gaps.setdefault(is_gap.tobytes(), []).append(name)
        for mask, column_names in gaps.items():
            is_gap = np.frombuffer(mask, bool)
            more = f" and {len(column_names) - _MAX_NAMED} more" if len(column_names) > _MAX_NAMED else ""
            names_text = ", ".join(f"'{name}'" for name in column_names[:_MAX_NAMED]) + more
            self.notes.append(
                f"The column{'s' * (len(column_names) > 1)} {names_text} "
                f"{'have each' if len(column_names) > 1 else 'has'} {is_gap.sum()} of {len(self.t)} values that are "
                f"not numbers, the first at {self.t[is_gap.argmax()]:g} s; there is nothing drawn for them."
            )

    def _remove_large_values(self, name: str) -> None:
        """Replace numbers that are too large for a pose by NaN, and note how many."""
        values = self.columns.get(name)
        if values is None or not (is_too_large := np.abs(values) > _MAX_POSE).any():
            return
        self.columns[name] = np.where(is_too_large, np.nan, values)
        self.notes.append(
            f"The column '{name}' has {int(is_too_large.sum())} of {len(is_too_large)} values beyond {_MAX_POSE:g}."
        )

    def _unwrap(self, name: str) -> None:
        """Make an angle within one turn continuous, so that it can be interpolated and thinned."""
        angle = self.columns[name]
        is_finite = np.isfinite(angle)
        if not is_finite.any():
            return
        low, high = float(angle[is_finite].min()), float(angle[is_finite].max())
        is_within_turn = (low >= -0.5 * _FULL_TURN - 1e-6 and high <= 0.5 * _FULL_TURN + 1e-6) or (
            low >= -1e-6 and high <= _FULL_TURN + 1e-6
        )
        values = angle[is_finite]
        if is_within_turn and np.abs(np.diff(values)).max(initial=0.0) > 0.5 * _FULL_TURN:
            self.columns[name] = angle.copy()
            self.columns[name][is_finite] = np.unwrap(values)
            self.notes.append(f"The column '{name}' was given within one turn; it is shown as a continuous angle.")


def _times(t: ArrayLike, name: str) -> NDArray[np.float64]:
    try:
        times = np.asarray(t, dtype=np.float64)
    except (TypeError, ValueError):
        raise ViewerError(f"The times of {name!r} are not numbers.") from None
    if times.ndim != 1 or len(times) == 0:
        raise ViewerError(f"The times of {name!r} have the shape {times.shape}; it must be (n,) with n of 1 or more.")
    if not np.isfinite(times).all():
        k = int((~np.isfinite(times)).argmax())
        raise ViewerError(f"The times of {name!r} must be numbers; time {k} (from 0 on) is {times[k]}.")
    decreases = np.diff(times) < 0.0
    if decreases.any():
        k = int(decreases.argmax())
        raise ViewerError(
            f"The times of {name!r} go back from {times[k]:g} s to {times[k + 1]:g} s; they must not decrease."
        )
    return times


def _column(name: str, values: ArrayLike, count: int) -> NDArray[np.float64]:
    array = np.asarray(values)
    if array.dtype.kind not in "fiub":
        raise ViewerError(f"The column {name!r} contains no numbers, but {array.dtype}.")
    if array.shape != (count,):
        raise ViewerError(
            f"The column {name!r} has the shape {array.shape}; there are {count} times, so it must be ({count},)."
        )
    return array.astype(np.float64, copy=False)


def _has_finite_value(values: NDArray[np.float64]) -> bool:
    return bool(np.isfinite(values).any())
