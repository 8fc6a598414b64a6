"""Writes recordings as one self-contained HTML file."""

from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any

from ali3.files import check_writable, write_bytes
from ali3.near_names import near_names
from ali3.scene.errors import ViewerError
from ali3.scene.recording import MAX_TIMES, Recording
from ali3.scene.written_file import WrittenPage
from viewer.html_document import html_document
from viewer.page_data import page_data
from viewer.player_options import check_options


def write_page(
    path: str | PathLike[str],
    recordings: Recording | Sequence[Recording],
    title: str | None = None,
    options: Mapping[str, Any] | None = None,
    most: int = MAX_TIMES,
) -> WrittenPage:
    """Write a page of one recording, or of several that are shown over each other.

    Parameters
    ----------
    path : path
        File to write, usually ``.html``; an existing one is replaced only when the new one is complete.
    recordings : Recording or sequence of Recording
        The first is drawn solid, the others as ghosts.
    title : str, optional
        Title of the page; by default the names of the recordings.
    options : mapping, optional
        Options of the player, see `viewer.player_options.OPTIONS`.
    most : int
        Largest number of times of a recording, which is thinned to it.

    Returns
    -------
    WrittenPage
        Path, size and notes.

    Raises
    ------
    ViewerError
        A recording or an option is wrong, or the script of the page is missing.
    FileError
        The file cannot be written; an older one is then unchanged.
    """
    check_writable(path)
    thinned_recordings = thinned(recordings, most)
    content = page_html(thinned_recordings, title, options).encode()
    write_bytes(path, content)
    return WrittenPage(Path(path), len(content), notes_of(thinned_recordings))


def page_html(
    recordings: Recording | Sequence[Recording],
    title: str | None = None,
    options: Mapping[str, Any] | None = None,
) -> str:
    """Text of the page that `write_page` writes, without thinning; see there."""
    recording_list = _recording_list(recordings)
    checked_options = check_options(options or {})
    known_names = dict.fromkeys(name for recording in recording_list for name in recording.columns)
    for name in checked_options.get("plots", ()):
        if name not in known_names:
            near = near_names(name, known_names, closeness=0.4) or list(known_names)[:3]
            raise ViewerError(f"There is no signal {name!r} to be plotted; there is {', '.join(near) or 'none'}.")
    data = page_data(recording_list, checked_options)
    page_title = (
        title if title is not None else ", ".join(dict.fromkeys(recording.name for recording in recording_list))
    )
    return html_document(page_title, data, "Player")


def thinned(recordings: Recording | Sequence[Recording], most: int = MAX_TIMES) -> list[Recording]:
    """Recordings with at most `most` times. Raises `ViewerError` for no recordings and for other objects."""
    return [recording.thinned(most) for recording in _recording_list(recordings)]


def _recording_list(recordings: Recording | Sequence[Recording]) -> list[Recording]:
    recording_list = [recordings] if isinstance(recordings, Recording) else list(recordings)
    if not recording_list:
        raise ViewerError("There is no recording to show.")
    for item in recording_list:
        if not isinstance(item, Recording):
            raise ViewerError(f"A page shows objects of the class Recording; this is one of {type(item).__name__}.")
    return recording_list


def notes_of(recordings: Sequence[Recording]) -> list[str]:
    """Notes of recordings, with their names if there are several."""
    notes = []
    for recording in recordings:
        prefix = f"{recording.name}: " if len(recordings) > 1 else ""
        notes += [prefix + note for note in recording.notes]
        notes += [f"{prefix}{item['name']} is not drawn: {item['why'].rstrip('.')}." for item in recording.missing]
    return notes
