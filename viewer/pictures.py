"""Takes pictures of recordings at single times, as PNG files."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any

from ali3.files import check_writable, write_bytes
from ali3.scene.errors import ViewerError
from ali3.scene.recording import Recording
from ali3.temporary_folder import temporary_folder
from viewer.browser import screenshot
from viewer.page_file import notes_of, thinned, write_page


def pictures(
    recordings: Recording | Sequence[Recording],
    times: Iterable[float],
    size: tuple[int, int] = (1280, 720),
    camera: str | None = None,
    options: Mapping[str, Any] | None = None,
) -> Iterator[bytes]:
    """Render recordings at single times, without controls.

    Parameters
    ----------
    recordings : Recording or sequence of Recording
        See `viewer.page_file.write_page`.
    times : iterable of float
        Times of the pictures, s.
    size : (int, int)
        Width and height, pixels.
    camera : str, optional
        Name of a camera; by default the one that the page starts with.
    options : mapping, optional
        Options of the player; ``controls`` is false by default.

    Yields
    ------
    bytes
        A PNG file for each time.

    Raises
    ------
    ViewerError
        There is nothing to draw.
    BrowserError
        No browser is installed that can render the page.
    """
    thinned_recordings = thinned(recordings)
    if all(recording.scene is None for recording in thinned_recordings):
        raise ViewerError("There is nothing to draw: no recording has a scene.")
    with temporary_folder() as folder:
        page = write_page(Path(folder, "page.html"), thinned_recordings, options={"controls": False, **(options or {})})
        yield from screenshot(page.path, times, size, camera)


def write_picture(
    path: str | PathLike[str],
    recordings: Recording | Sequence[Recording],
    time: float,
    size: tuple[int, int] = (1280, 720),
    camera: str | None = None,
    options: Mapping[str, Any] | None = None,
) -> list[str]:
    """Write one picture as a PNG file; the other arguments as in `pictures`.

    Parameters
    ----------
    path : path
        File to write; an existing one is replaced only when the new one is complete.
    time : float
        Time of the picture, s, within the recordings.

    Returns
    -------
    list of str
        Notes: what was not drawn, and how recordings were thinned.

    Raises
    ------
    ViewerError
        The file name does not end in .png, there is nothing to draw, or the time is outside the recordings.
    BrowserError
        No browser is installed that can render the page.
    FileError
        The file cannot be written.
    """
    if Path(path).suffix.lower() != ".png":
        raise ViewerError(f"{path} must end with .png.")
    check_writable(path)
    thinned_recordings = thinned(recordings)
    start = min(recording.t[0] for recording in thinned_recordings)
    end = max(recording.t[-1] for recording in thinned_recordings)
    if not start <= time <= end:
        raise ViewerError(f"There is no picture at {time:g} s; it was recorded from {start:g} s to {end:g} s.")
    (picture,) = pictures(thinned_recordings, [time], size, camera, options)
    write_bytes(path, picture)
    return notes_of(thinned_recordings)
