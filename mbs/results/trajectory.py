"""Trajectory of a run: arrays by sensor name, with units."""

from __future__ import annotations

import csv
import html
from collections.abc import Iterator, Mapping, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ali3.columns import some_of
from ali3.errors import TableError, UserError
from ali3.files import atomic_file
from ali3.message_text import brief
from ali3.near_names import did_you_mean
from ali3.scene.drawer import drawer
from ali3.scene.recording import Recording
from ali3.scene.scene import check_scene
from ali3.tables import TextTable
from mbs.common.checks import flag, shown, whole
from mbs.elements.road import PortRoad, Road
from mbs.results.accuracy import Accuracy
from mbs.results.omitted_sensors import OmittedSensors
from mbs.results.poses import Poses
from mbs.results.run_report import Report
from mbs.results.step_control import Control
from mbs.roads.scene_part import drawn_roads, scene_part
from mbs.settings.settings import Settings
from mbs.system.drawing import Drawing

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Trajectory(Mapping[str, NDArray[np.float64]]):
    """Sensor values over time: ``trajectory["bob.x"]`` is an array of shape (n,).

    Parameters
    ----------
    t : array of shape (n,)
        Times, s.
    values : array of shape (n, ns)
        Sensor values, one column per name.
    names, units : sequence of str
        Names and units of the ns sensors.
    report : Report, optional
        Counters and residuals of the solver.
    settings : Settings, optional
        Method, tolerances and further settings of the solver.
    wall_s : float
        Wall time of the steps, s, of all runs that a tolerance needed; preparation of inputs, progress reports and a
        refined run are excluded.
    accuracy : Accuracy, optional
        Estimated error, with the refined run it comes from.
    notices : sequence of str
        Notices of the scene, see `Model.notice`; evaluated at the recorded times.
    branch_change : str
        A sentence about the first change of the assembly mode of a closed loop; empty if there was none.
    control : Control, optional
        Record of the choice of method and steps, if `simulate` chose them.
    drawing : Drawing, optional
        Scene of the model, for `mbs.animate`.
    roads : mapping of int to road or str, optional
        Roads of the run that differ from the drawing, by their numbers: moved by parameters, or paths of files.
    left_out : OmittedSensors, optional
        Sensors among `names` that the run did not compute; their columns of `values` are ignored.
    """

    def __init__(
        self,
        t: NDArray[np.float64],
        values: NDArray[np.float64],
        names: list[str],
        units: list[str],
        report: Report | None = None,
        settings: Settings | None = None,
        wall_s: float = float("nan"),
        accuracy: Accuracy | None = None,
        notices: Sequence[str] = (),
        branch_change: str = "",
        control: Control | None = None,
        poses: Poses | None = None,
        drawing: Drawing | None = None,
        roads: Mapping[int, Road | str] | None = None,
        left_out: OmittedSensors | None = None,
    ) -> None:
        self.t = t
        self._omitted = left_out if left_out is not None else OmittedSensors((), None)
        omitted_names = set(self._omitted.names)
        unavailable_names = set() if self._omitted.can_be_computed else omitted_names
        self.units = {name: unit for name, unit in zip(names, units, strict=True) if name not in unavailable_names}
        self.report = report
        self.settings = settings
        self.wall_s = wall_s
        self.accuracy = accuracy
        self.notices = tuple(notices)
        self.branch_change = branch_change
        self.control = control
        self.drawing = drawing
        self.roads = dict(roads or {})
        self._poses = poses
        self._columns = {name: values[:, i] for i, name in enumerate(names) if name not in omitted_names}

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        if isinstance(name, str) and name in self._omitted.names:
            return self._omitted.column(name)
        if not isinstance(name, str) or name not in self._columns:
            hint = did_you_mean(str(name), self.units, f"the trajectory has: {some_of(self.units)}")
            raise KeyError(f"There is no sensor {shown(name)}{hint}")
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.units)

    def __len__(self) -> int:
        return len(self.units)

    @property
    def poses(self) -> Poses:
        """Poses of all bodies, ``run.poses["rod.x"]``; they have times of their own, `Poses.t`.

        Raises
        ------
        ValueError
            There are none: the System came from a file without a drawing, or the results from one without poses.
        """
        if self._poses is None:
            raise ValueError(
                "This trajectory has no poses; runs of compiled models have them, and files that "
                "to_csv(..., poses=True) wrote."
            )
        return self._poses

    def recording(self, scene: Mapping[str, Any] | None = None, name: str = "") -> Recording:
        """The run as a recording for drawing: a scene, times, and sensors and poses as columns.

        Parameters
        ----------
        scene : mapping, optional
            Scene to draw; by default the scene of the run.
        name : str
            Name of the recording; by default the name of the model.

        Returns
        -------
        Recording
            Samples at the times of the poses.

        Raises
        ------
        ValueError
            The run has no scene and none is given, the scene is not a mapping, or the run has none of its poses.
        ali3.scene.errors.ViewerError
            The scene is not of the format.
        mbs.RoadFileError
            The file of a road of the run can no longer be read.
        """
        if scene is None:
            if self.drawing is None:
                raise ValueError(
                    "This trajectory has no drawing; give the System as the scene, as in animate(run, scene=system)."
                )
            scene = self.drawing.scene
        elif not isinstance(scene, Mapping):
            raise ValueError(f"What is drawn of a trajectory must be a System or its scene, not {shown(scene)}.")
        else:
            check_scene(scene)
        scene = {**scene, "roads": self._drawn_roads(scene.get("roads", []))}
        poses = self._poses
        every = 1 if poses is None else poses.every
        columns, units = {n: v[::every] for n, v in self.items()}, dict(self.units)
        if poses is not None:
            columns, units = poses.recorded(columns, units)
        recording = Recording(scene, self.t[::every] if poses is None else poses.t, columns, units, name)
        if recording.scene is None:
            scene_name = shown(scene["name"])
            if poses is not None:
                bodies = ", ".join(poses.bodies)
                raise ValueError(f"This trajectory has none of the poses of {scene_name}; its bodies are: {bodies}.")
            raise ValueError(
                f"This trajectory has no poses, by which {scene_name} would be drawn; files have them that "
                "to_csv(..., poses=True) wrote."
            )
        if every > 1:
            recording.notes.append(f"Poses were stored for one of {every} samples of the run.")
        return recording

    def _drawn_roads(self, roads: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
        """Roads of a scene with those that this run replaced; road files are read."""
        entries = [dict(road) for road in roads]
        for k, entry in enumerate(entries):
            road = self.roads.get(entry.get("number", k))
            if road is not None and not isinstance(road, PortRoad):
                entries[k] = {"kind": "file", "path": road} if isinstance(road, str) else scene_part(road)
        return drawn_roads(entries)

    def _repr_html_(self) -> str | None:
        """Animation of the run in a notebook; a text if it cannot be drawn, None if it has no drawing."""
        if self.drawing is None or len(self.t) < 2:
            return None
        try:
            return drawer().html_of(self.recording())
        except (UserError, ValueError) as error:
            return f"<pre>{html.escape(repr(self))}</pre><p>{html.escape(str(error))}</p>"

    def thinned(self, every: int) -> Trajectory:
        """Keep every n-th sample, including the first, with the same report, settings and accuracy.

        Parameters
        ----------
        every : int
            One of this many samples is kept.

        Returns
        -------
        Trajectory
            A new one; this one itself if `every` is 1.

        Raises
        ------
        ValueError
            It is not a whole number above zero.
        """
        every = whole(every, "every", 1, 10**9, ValueError)
        if every == 1:
            return self
        zeros = np.zeros(len(self.t))
        columns = [self._columns.get(name, zeros) for name in self.units]
        values = np.column_stack(columns) if columns else np.empty((len(self.t), 0))
        names, units = list(self.units), list(self.units.values())
        unchanged = (
            self.report,
            self.settings,
            self.wall_s,
            self.accuracy,
            self.notices,
            self.branch_change,
            self.control,
        )
        poses = None if self._poses is None else self._poses.thinned(every)
        omitted = self._omitted.thinned(every)
        return Trajectory(
            self.t[::every], values[::every], names, units, *unchanged, poses, self.drawing, self.roads, omitted
        )

    @property
    def realtime_factor(self) -> float:
        """Simulated time over wall time: above 1 is faster than real time."""
        return float((self.t[-1] - self.t[0]) / self.wall_s)

    def __repr__(self) -> str:
        accuracy_text = f"; {self.accuracy}" if self.accuracy is not None and str(self.accuracy) else ""
        notices_text = "".join(f" {text}" for text in (*self.notices, self.branch_change) if text)
        samples = f"{len(self.t)} samples from {self.t[0]:g} s to {self.t[-1]:g} s"
        text = f"Trajectory({samples}, {len(self)} sensors{accuracy_text}){notices_text}"
        return text if self.control is None else f"{text}\n  {self.control}"

    def to_csv(self, path: str | PathLike[str], poses: bool = False) -> None:
        """Write one column per sensor, headed ``name [unit]``, with all digits.

        Parameters
        ----------
        path : str or path-like
            File to write; an existing one is replaced only by a complete one.
        poses : bool
            Whether to add the poses of all bodies, ``rod.x [m]`` to ``rod.qz [1]``, from which `from_csv`,
            ``animate(..., scene=system)`` and ``ali3 view`` draw the run. If a sensor has such a name, the columns
            are ``rod.pose.x`` to ``rod.pose.qz``.

        Raises
        ------
        OSError
            The file cannot be written.
        ValueError
            The run has no poses, or has them at some of its samples only.
        """
        columns, units = dict(self), dict(self.units)
        if flag(poses, "The poses of to_csv", ValueError):
            if self.poses.every > 1:
                raise ValueError(
                    f"Poses were stored for one of {self.poses.every} samples; write "
                    f"run.thinned({self.poses.every}).to_csv(..., poses=True)."
                )
            columns, units = self.poses.recorded(columns, units)
        with atomic_file(path, make_parents=False) as target, target.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(["time [s]", *(f"{name} [{unit}]" for name, unit in units.items())])
            writer.writerows(np.column_stack([self.t, *columns.values()]).tolist())

    @classmethod
    def from_csv(cls, path: str | PathLike[str]) -> Trajectory:
        """Read a file that `to_csv` wrote; counters and settings are not in the file.

        Returns
        -------
        Trajectory
            Times, values, names and units; poses of the bodies with all seven columns ``.x`` to ``.qz``, which also
            remain sensors.

        Raises
        ------
        TableError
            The file cannot be read, or a heading or a value is not what `to_csv` writes; the message names the line.
        """
        table = TextTable(path, TableError, known=("time",), units=True)
        names = table.names[1:]
        if table.names[0] != "time" or table.units.get("time") != "s":
            raise TableError(f"{path}: the first line must be 'time [s]' and one 'name [unit]' per sensor.")
        for name in names:
            if name not in table.units:
                raise TableError(f"{path}: the heading {brief(name)} must read 'name [unit]'.")
        data = table.values(finite=False, least=0)
        poses = Poses.of_columns(data[:, 0], dict(zip(names, data[:, 1:].T, strict=True)))
        return cls(data[:, 0], data[:, 1:], names, [table.units[name] for name in names], poses=poses)

    def plot(self, *names: str) -> Figure:
        """Draw sensors over time with matplotlib, one diagram per unit.

        Parameters
        ----------
        *names : str
            Sensors; all when none is named.

        Returns
        -------
        matplotlib.figure.Figure
            Not shown yet.

        Raises
        ------
        ValueError
            The trajectory has no sensors.
        """
        import matplotlib.pyplot as plt

        chosen = names or tuple(self)
        groups: dict[str, list[str]] = {}
        for name in chosen:
            self[name]
            groups.setdefault(self.units[name], []).append(name)
        if not groups:
            raise ValueError("There is nothing to draw: the trajectory has no sensors.")
        figure, axes = plt.subplots(
            len(groups), 1, sharex=True, squeeze=False, figsize=(9, 2.5 + 2 * len(groups)), layout="constrained"
        )
        for ax, (unit, members) in zip(axes[:, 0], groups.items(), strict=True):
            for name in members:
                ax.plot(self.t, self[name], label=name)
            ax.set_ylabel(unit)
            ax.grid(True, alpha=0.3)
            ax.legend(loc="upper right", fontsize="small")
        axes[-1, 0].set_xlabel("time, s")
        return figure
