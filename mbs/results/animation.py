"""Animations of runs: as a page, in a notebook, as a glTF file, as a film."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ali3.scene.drawer import drawer
from ali3.scene.recording import Recording
from ali3.scene.written_file import WrittenFilm, WrittenGltf, WrittenPage
from mbs.common.checks import instance_of, shown, text
from mbs.results.trajectory import Trajectory
from mbs.system.system import System


class Animation:
    """Animation of runs, returned by `animate`; a notebook shows it.

    Attributes
    ----------
    recordings : list of Recording
        The run, then its ghosts.
    options : dict
        Initial state of the player.
    """

    def __init__(self, recordings: list[Recording], options: Mapping[str, Any]) -> None:
        self.recordings = recordings
        self.options = dict(options)

    def __repr__(self) -> str:
        names = ", ".join(recording.name for recording in self.recordings)
        return f"Animation({names}; save(path), show(), to_gltf(path) and to_mp4(path) make something of it)"

    def _repr_html_(self) -> str:
        return drawer().html_of(self.recordings, options=self.options)

    def save(self, path: str | os.PathLike[str]) -> WrittenPage:
        """Write one HTML file that any browser shows, without a network.

        Parameters
        ----------
        path : path
            Usually ``.html``; an older file is replaced when the new one is whole.

        Returns
        -------
        WrittenPage
            Path, size and notes, such as a thinning.

        Raises
        ------
        ali3.scene.errors.ViewerError
            The script of the page is not there and cannot be built.
        ali3.errors.FileError
            The file cannot be written.
        """
        return drawer().write_page(path, self.recordings, options=self.options)

    def show(self) -> Path:
        """Open the page in the user's browser.

        Returns
        -------
        Path
            The page, in the folder for temporary files.

        Raises
        ------
        viewer.browser.BrowserError
            There is no browser here, or no screen.
        ali3.scene.errors.ViewerError
            The script of the page is not there and cannot be built.
        """
        return drawer().show(self.recordings, self.options)

    def to_gltf(self, path: str | os.PathLike[str], **settings: Any) -> WrittenGltf:
        """Write the run, without its ghosts, as a glTF animation for Blender and others.

        Parameters
        ----------
        path : path
            ``.glb`` or ``.gltf``.
        **settings
            Arguments of `viewer.gltf.write_gltf`: ``rate``, ``speed``, ``road``, ``deformation`` (by default from the
            options).

        Returns
        -------
        WrittenGltf
            Path, size and the error of the thinning.

        Raises
        ------
        ali3.scene.errors.ViewerError
            A setting is wrong.
        ali3.errors.FileError
            The file cannot be written.
        """
        factor = {"deformation": self.options["deformation"]} if "deformation" in self.options else {}
        return drawer().write_gltf(path, self.recordings[0], **(factor | settings))

    def to_mp4(self, path: str | os.PathLike[str], **settings: Any) -> WrittenFilm:
        """Write a film, drawn by a Chromium without a window.

        Parameters
        ----------
        path : path
            ``.mp4``, or ``.webp`` and ``.gif`` for documents.
        **settings
            Arguments of `viewer.video.write_mp4`: ``fps``, ``size``, ``camera``, ``speed``, ``begin``, ``end``,
            ``progress``.

        Returns
        -------
        WrittenFilm
            Path, size and duration.

        Raises
        ------
        ali3.scene.errors.ViewerError
            A setting is wrong.
        viewer.browser.BrowserError
            There is no Chromium.
        ali3.errors.FileError
            The file cannot be written.
        """
        return drawer().write_mp4(path, self.recordings, options=self.options, **settings)


def animate(
    run: Trajectory,
    *ghosts: Trajectory,
    path: str | os.PathLike[str] | None = None,
    names: tuple[str, ...] | list[str] | None = None,
    scene: System | Mapping[str, Any] | None = None,
    **options: Any,
) -> Animation:
    """See a run move: a page with a time slider, cameras, plots, forces as arrows and stresses as colours.

    Parameters
    ----------
    run : Trajectory
        Of `simulate` or `Simulation.run`.
    *ghosts : Trajectory
        Other runs that are drawn over it, see-through.
    path : path, optional
        Where to save the page at once, as ``animate(run).save(path)`` does.
    names : sequence of str, optional
        Names of the runs, one each; by default the name of the model, for ghosts with their number.
    scene : System or mapping, optional
        Scene for runs that have none because they were read from a file.
    **options
        Initial state of the player, such as ``camera="side"``, ``plots=["bob.x"]``, ``speed=0.5``; see
        `viewer.player_options.OPTIONS`.

    Returns
    -------
    Animation
        To be saved, shown, or the last line of a notebook's cell.

    Raises
    ------
    ValueError
        There is not one name for each run, or a run has no poses or no scene.
    ali3.scene.errors.ViewerError
        An option is wrong, or the scene does not fit the run.

    Examples
    --------
    >>> import mbs
    >>> from mbs.scenes import pendulum
    >>> run = mbs.simulate(mbs.compile(pendulum.build()), 2.0, 0.01)
    >>> mbs.animate(run, plots=["bob.position.x"]).recordings[0].name
    'pendulum'
    """
    runs = [instance_of(Trajectory, each, "What animate draws", "a Trajectory") for each in (run, *ghosts)]
    checked = drawer().check_options(options)
    if names is not None and len(names) != len(runs):
        raise ValueError(f"There are {len(names)} names for {len(runs)} runs: {shown(names)}; give one for each.")
    drawn_scene = scene.scene if isinstance(scene, System) else scene
    recordings = []
    for k, each in enumerate(runs):
        name = "" if names is None else text(names[k], "the name of a run", ValueError)
        recording = each.recording(drawn_scene, name)
        if names is None and k > 0:
            recording.name = f"{recording.name} {k + 1}"
        recordings.append(recording)
    animation = Animation(recordings, checked)
    if path is not None:
        animation.save(path)
    return animation
