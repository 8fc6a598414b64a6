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
    """Pictures of recordings without anything but the drawing.

    Parameters
    ----------
    recordings : Recording or sequence of Recording
        As `viewer.page_file.write_page` takes them.
    times : iterable of float
        s.
    size : (int, int)
        Pixels.
    options : mapping, optional
        Of the player; ``controls`` is false if they do not say otherwise.

    Yields
    ------
    bytes
        A PNG file for each time.

    Raises
    ------
    ViewerError
        There is nothing to draw.
    BrowserError
        There is no browser that draws.
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
    """Write a picture of recordings at one time, a PNG file; see `pictures`.

    Parameters
    ----------
    path : path
        File to write; one that is there is replaced when the new one is whole.
    time : float
        s; one outside the recordings is refused.
    size : (int, int)
        Pixels.

    Returns
    -------
    list of str
        Sentences: what is not drawn, thinning.

    Raises
    ------
    ViewerError
        The file does not end with .png, or there is nothing to draw, or nothing at that time.
    BrowserError
        There is no browser that draws.
    FileError
        The file cannot be written.
    """
    if Path(path).suffix.lower() != ".png":
        raise ViewerError(f"{path} would be a picture; it must end with .png.")
    check_writable(path)
    thinned_recordings = thinned(recordings)
    begin, end = min(r.t[0] for r in thinned_recordings), max(r.t[-1] for r in thinned_recordings)
    if not begin <= time <= end:
        raise ViewerError(f"There is no picture at {time:g} s; it was recorded from {begin:g} s to {end:g} s.")
    (picture,) = pictures(thinned_recordings, [time], size, camera, options)
    write_bytes(path, picture)
    return notes_of(thinned_recordings)
