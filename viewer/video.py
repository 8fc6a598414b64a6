"""Writes films of recordings: pictures of the page as MP4, animated WebP or animated GIF."""

from __future__ import annotations

import io
import math
import os
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from contextlib import closing
from fractions import Fraction
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ali3.bars import bar as bar_of
from ali3.errors import UserError
from ali3.extras import missing_package
from ali3.files import atomic_file, check_writable
from ali3.scene.errors import ViewerError
from ali3.scene.recording import Recording
from ali3.scene.written_file import WrittenFilm
from ali3.temporary_folder import temporary_folder
from viewer.browser import screenshot
from viewer.page_file import notes_of, thinned, write_page

if TYPE_CHECKING:
    from PIL.Image import Image

SUFFIXES = (".mp4", ".webp", ".gif")
MAX_FRAMES = 20_000
Progress = Callable[[float], None]
_QUALITY = "12"  # constant rate factor of x264; 0 is lossless
_WEBP = {"quality": 50, "method": 4, "allow_mixed": True}


class FilmError(UserError, RuntimeError):
    """A package that makes films is not installed, or fails; the message gives the remedy."""


def write_mp4(
    path: str | os.PathLike[str],
    recordings: Recording | Sequence[Recording],
    *,
    fps: float = 30.0,
    size: tuple[int, int] = (1280, 720),
    camera: str | None = None,
    speed: float = 1.0,
    begin: float | None = None,
    end: float | None = None,
    options: Mapping[str, Any] | None = None,
    progress: bool | Progress | None = None,
) -> WrittenFilm:
    """Write a film of a recording, or of several that are shown over each other.

    A Chromium without a window draws the pictures, by the processor: one of 1280 x 720 takes a second or less.
    ffmpeg (in the package av) encodes them as H.264. Files ``.webp`` and ``.gif`` are animated pictures for
    documents, which play without end.

    Parameters
    ----------
    path : path
        ``.mp4``, ``.webp`` or ``.gif``; an existing file is replaced only when the new one is complete.
    recordings : Recording or sequence of Recording
        The first is drawn solid, the others as ghosts.
    fps : float
        Pictures a second, 1 to 120; the times between two of a GIF are multiples of 10 ms.
    size : (int, int)
        Width and height, pixels, both even for ``.mp4``.
    camera : str, optional
        Name of a camera; by default the one that the page starts with.
    speed : float
        Speed of the film; 1 is real time, 0.1 slow motion.
    begin, end : float, optional
        Part of the recording, s; by default all of the first one.
    options : mapping, optional
        Options of the page, such as ``{"stress": True, "deformation": 20.0}``; see
        `viewer.player_options.OPTIONS`.
    progress : bool or callable, optional
        None: a bar after two seconds; True: at once; False: none. A function receives the completed fraction.

    Returns
    -------
    WrittenFilm
        Path, size and duration.

    Raises
    ------
    ViewerError
        A recording or an argument is wrong.
    BrowserError
        No browser is installed, or it cannot draw.
    FilmError
        The package av is not installed, or it fails.
    FileError
        The file cannot be written; an older one is then unchanged.
    """
    target = Path(path)
    thinned_recordings = thinned(recordings)
    times = _times(target, thinned_recordings[0], fps, size, speed, begin, end)
    check_writable(path)
    encode = _mp4_encoder(fps, size) if target.suffix.lower() == ".mp4" else _animation_encoder(target, fps)
    with temporary_folder() as folder:
        page = Path(folder, "page.html")
        player_options = {**(options or {}), "controls": False, "play": False}
        write_page(page, thinned_recordings, options=player_options)
        pictures = _decode(screenshot(page, times, size, camera), len(times), progress)
        with closing(pictures), atomic_file(path) as temporary:
            encode(temporary, pictures)
            file_size = temporary.stat().st_size
    return WrittenFilm(target, file_size, len(times), len(times) / fps, notes_of(thinned_recordings))


def _times(
    target: Path,
    recording: Recording,
    fps: float,
    size: tuple[int, int],
    speed: float,
    begin: float | None,
    end: float | None,
) -> list[float]:
    """Times of the pictures, s."""
    if target.suffix.lower() not in SUFFIXES:
        raise ViewerError(f"{target} must end with .mp4, .webp or .gif.")
    if recording.scene is None:
        raise ViewerError(f"{recording.name!r} has no scene: there is nothing to film.")
    _check_number("fps", fps, 1.0, 120.0)
    _check_number("speed", speed, 1e-4, 1e4)
    _check_size(target, size)
    first, last = float(recording.t[0]), float(recording.t[-1])
    for name, value in (("begin", begin), ("end", end)):
        if value is not None:
            _check_number(name, value, first, last)
    first = first if begin is None else float(begin)
    last = last if end is None else float(end)
    if first > last:
        raise ViewerError(f"The film must begin at {first:g} s and to end before that, at {last:g} s.")
    count = math.floor((last - first) / speed * fps * (1.0 + 1e-9)) + 1
    if count > MAX_FRAMES:
        raise ViewerError(
            f"The film would have {count} pictures, at most {MAX_FRAMES} are made; choose begin and end, a higher "
            "speed or a lower fps."
        )
    return [min(first + k * speed / fps, last) for k in range(count)]


def _check_number(name: str, value: object, low: float, high: float) -> None:
    if isinstance(value, bool) or not isinstance(value, Real) or not low <= float(value) <= high:
        raise ViewerError(f"{name} of the film is {value!r}; it must be a number from {low:g} to {high:g}.")


def _check_size(target: Path, size: Any) -> None:
    sides = list(size) if isinstance(size, (tuple, list)) else []
    if len(sides) != 2 or not all(type(n) is int and 16 <= n <= 8192 for n in sides):
        raise ViewerError(f"The size of the film is {size!r}; it must be two numbers of pixels from 16 to 8192.")
    if target.suffix.lower() == ".mp4" and any(n % 2 for n in size):
        raise ViewerError(f"The size of the film is {size!r}; both numbers must be even for an MP4 file.")


def _decode(
    pictures: Generator[bytes, None, None], count: int, progress: bool | Progress | None
) -> Generator[Image, None, None]:
    """Decode PNG files to pictures one by one, with a progress bar."""
    try:
        from PIL import Image
    except ModuleNotFoundError:
        raise FilmError(f"A film cannot be written. {missing_package('PIL', 'pictures')}") from None
    report, close = _progress_functions(count, progress)
    try:
        with closing(pictures):  # otherwise an error would keep the browser open as long as the error exists
            for number, data in enumerate(pictures):
                yield Image.open(io.BytesIO(data)).convert("RGB")
                report(number + 1)
    finally:
        close()


def _progress_functions(
    count: int, progress: bool | Progress | None
) -> tuple[Callable[[int], None], Callable[[], None]]:
    """Functions that report the number of finished pictures, and that close the bar."""
    if callable(progress):
        return lambda number: progress(number / count), lambda: None
    if progress is False:
        return lambda number: None, lambda: None
    try:
        bar = bar_of(total=count, desc="film", unit="picture", delay=2.0 if progress is None else 0.0, leave=False)
    except ModuleNotFoundError:
        return lambda number: None, lambda: None
    return lambda number: bar.update(1) and None, bar.close


def _mp4_encoder(fps: float, size: tuple[int, int]) -> Callable[[Path, Iterator[Image]], None]:
    try:
        import av
    except ModuleNotFoundError:
        raise FilmError(f"An MP4 file cannot be written. {missing_package('av')}") from None

    def encode(path: Path, pictures: Iterator[Image]) -> None:
        try:
            with av.open(path, "w", format="mp4") as film:
                stream = film.add_stream("libx264", Fraction(fps).limit_denominator(1000), options={"crf": _QUALITY})
                stream.width, stream.height = size
                stream.pix_fmt = "yuv420p"
                for picture in pictures:
                    film.mux(stream.encode(av.VideoFrame.from_ndarray(np.asarray(picture))))
                film.mux(stream.encode())
        except av.FFmpegError as error:
            raise FilmError(f"ffmpeg does not encode the film: {error.strerror}.") from None

    return encode


def _animation_encoder(target: Path, fps: float) -> Callable[[Path, Iterator[Image]], None]:
    kind = target.suffix.lower()[1:]

    def encode(path: Path, pictures: Iterator[Image]) -> None:
        first_picture = next(pictures)
        options: dict[str, Any] = dict(_WEBP) if kind == "webp" else {"optimize": False, "disposal": 1}
        first_picture.save(
            path,
            format=kind.upper(),
            save_all=True,
            append_images=pictures,
            duration=_milliseconds(fps, kind),
            loop=0,
            **options,
        )

    return encode


def _milliseconds(fps: float, kind: str) -> int:
    """Duration of a picture: at least two steps, of 10 ms for GIF and 1 ms for WebP."""
    step = 10 if kind == "gif" else 1
    return max(2 * step, step * round(1000.0 / fps / step))
