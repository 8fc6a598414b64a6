"""Films: as many pictures as asked for, of the size asked for, that show the motion of the recording."""

import sys

import av
import numpy as np
import pytest
from PIL import Image

from ali3.errors import FileError
from ali3.scene.errors import ViewerError
from ali3.scene.recording import Recording
from tests.viewer import hand_scenes
from viewer import browser, bundle, video
from viewer.browser import BrowserError
from viewer.video import FilmError, write_mp4

SIZE = (320, 180)
T = np.linspace(0.0, np.pi, 101)  # the crank turns once


@pytest.fixture(scope="module")
def _drawn():
    """Skip where nothing can be drawn."""
    try:
        browser.find_chromium()
        bundle.bundle()
    except (BrowserError, RuntimeError) as error:
        pytest.skip(str(error))


def frames_of(path):
    if path.suffix == ".mp4":
        with av.open(path) as film:
            return [frame.to_ndarray(format="rgb24") for frame in film.decode(video=0)]
    with Image.open(path) as file:
        results = []
        for k in range(file.n_frames):
            file.seek(k)
            results.append(np.asarray(file.convert("RGB")))
        return results


def slider(picture):
    """Where the red box stands, as a share of the width."""
    r, g, b = (picture[..., k].astype(float) for k in range(3))
    red = (r > 90) & (r > 1.7 * g) & (r > 1.7 * b)
    assert red.sum() > 10
    return float(np.nonzero(red)[1].mean()) / picture.shape[1]


@pytest.mark.slow
@pytest.mark.usefixtures("_drawn")
def test_a_film_shows_the_motion_of_the_recording(tmp_path):
    path = tmp_path / "crank.mp4"
    progress = []
    written = write_mp4(path, hand_scenes.crank(T), size=SIZE, fps=4.0, speed=1.0, progress=progress.append)
    assert written.frames == 13
    assert written.duration == pytest.approx(13 / 4.0)
    assert written.size == path.stat().st_size
    assert progress == pytest.approx((np.arange(13) + 1) / 13)
    pictures = frames_of(path)
    assert len(pictures) == 13
    assert pictures[0].shape == (SIZE[1], SIZE[0], 3)
    a = 2.0 * np.arange(13) / 4.0
    x = 0.5 * np.cos(a) + np.sqrt(1.0 - (0.5 * np.sin(a)) ** 2)
    values = np.array([slider(picture) for picture in pictures])
    slope, start = np.polyfit(x, values, 1)
    assert slope > 0.1
    assert np.abs(values - (start + slope * x)).max() < 0.02


@pytest.mark.slow
@pytest.mark.usefixtures("_drawn")
def test_slow_motion_of_a_part(tmp_path):
    path = tmp_path / "crank.webp"
    written = write_mp4(path, hand_scenes.crank(T), size=SIZE, fps=10, speed=0.1, begin=1.0, end=1.05, progress=False)
    assert written.frames == 6
    values = np.array([slider(picture) for picture in frames_of(path)])
    assert np.ptp(values) < 0.05


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"path": "a.avi"}, r"must end with \.mp4, \.webp or \.gif\.$"),
        ({"fps": 0}, r"^fps of the film is 0; it must be a number from 1 to 120\.$"),
        ({"fps": float("nan")}, r"^fps of the film is nan; "),
        ({"speed": -1.0}, r"^speed of the film is -1\.0; "),
        ({"size": (640, 361)}, r"both numbers must be even for an MP4 file\.$"),
        ({"size": "large"}, r"^The size of the film is 'large'; it must be two numbers of pixels from 16 to 8192\.$"),
        ({"size": (1, 2)}, r"it must be two numbers of pixels from 16 to 8192\.$"),
        ({"begin": 7.0}, r"^begin of the film is 7\.0; it must be a number from 0 to 3\.14159\.$"),
        ({"begin": 2.0, "end": 1.0}, r"^The film must begin at 2 s and to end before that, at 1 s\.$"),
        ({"speed": 1e-4}, r"^The film would have \d+ pictures, at most 20000 are made; "),
        ({"recording": Recording(None, T, {"a": T}, name="plots")}, r"^'plots' has no scene"),
        ({"recording": []}, r"^There is no recording to show\.$"),
    ],
)
def test_invalid_film_settings_are_refused_in_one_sentence(tmp_path, arguments, message):
    path = tmp_path / arguments.pop("path", "a.mp4")
    recording = arguments.pop("recording", None)
    recording = hand_scenes.crank(T) if recording is None else recording
    with pytest.raises(ViewerError, match=message):
        write_mp4(path, recording, **arguments)
    assert list(tmp_path.iterdir()) == []


def test_without_a_browser(tmp_path, monkeypatch):
    monkeypatch.setenv(browser.VARIABLE, "no-such-browser")
    monkeypatch.setattr(video, "write_page", lambda path, *_, **__: path.write_text(""))
    with pytest.raises(BrowserError, match=r"names no-such-browser, which is not a program\.$"):
        write_mp4(tmp_path / "a.mp4", hand_scenes.crank(T))
    assert list(tmp_path.iterdir()) == []


def test_without_the_package_that_encodes(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "av", None)
    with pytest.raises(FilmError, match=r'run: python -m pip install "ali3\[pictures\]"$'):
        write_mp4(tmp_path / "a.mp4", hand_scenes.crank(T))


@pytest.mark.slow
@pytest.mark.usefixtures("_drawn")
def test_a_film_that_ffmpeg_refuses(tmp_path, monkeypatch):
    monkeypatch.setattr(video, "_QUALITY", "no number")
    with pytest.raises(FilmError, match=r"^ffmpeg does not encode the film: .*\.$"):
        write_mp4(tmp_path / "a.mp4", hand_scenes.crank(T), size=SIZE, fps=2.0)
    assert list(tmp_path.iterdir()) == []


def test_a_folder_is_no_film(tmp_path):
    (tmp_path / "a.mp4").mkdir()
    with pytest.raises(FileError, match="is a folder"):
        write_mp4(tmp_path / "a.mp4", hand_scenes.crank(T))
