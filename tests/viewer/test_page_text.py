"""The text of a page: complete or not written, self-contained, safe from any name; the output of a notebook."""

import base64
import gzip
import html
import json
import re
import struct
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ali3.errors import FileError
from ali3.scene.errors import ViewerError
from ali3.scene.recording import Recording
from tests.viewer.hand_scenes import crank
from viewer import html_document
from viewer.notebook import html_of
from viewer.page_data import page_data
from viewer.page_file import page_html, write_page

TIMES = np.linspace(0.0, 1.0, 11)
HOSTILE = "</script><script>alert(1)</script><!-- & \" ' \u2028 ]]>"


@pytest.fixture(autouse=True)
def _short_script(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(html_document, "script", lambda: "var ALi3Viewer={};")


class Elements(HTMLParser):
    """Elements of a page with their attributes and texts."""

    def __init__(self, text: str) -> None:
        super().__init__(convert_charrefs=True)
        self.found: list[tuple[str, dict[str, str | None], str]] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, dict(attrs), ""))

    def handle_data(self, data: str) -> None:
        if self.found:
            tag, attributes, text = self.found[-1]
            self.found[-1] = (tag, attributes, text + data)


def data_of(page: str) -> Any:
    return json.loads(next(text for tag, attributes, text in Elements(page).found if attributes.get("id") == "data"))


def numbers(block: dict[str, Any]) -> dict[str, np.ndarray]:
    """The columns of a block, read as its description says."""
    raw = gzip.decompress(base64.b64decode(block["data"]))
    size = int(block["kind"][1])
    count = len(raw) // size
    letter = {"f8": "d", "f4": "f"}[block["kind"]]
    values = [
        struct.unpack("<" + letter, bytes(raw[k + plane * count] for plane in range(size)))[0] for k in range(count)
    ]
    return dict(zip(block["names"], np.array(values).reshape(len(block["names"]), -1), strict=True))


def test_a_page_holds_the_numbers_poses_in_double_precision() -> None:
    recording = crank(TIMES)
    page = data_of(page_html(recording))
    (run,) = page["runs"]
    np.testing.assert_array_equal(numbers(run["time"])["time"], TIMES)
    fine, rough = (numbers(block) for block in run["blocks"])
    assert set(fine) | set(rough) == set(run["order"]) == set(recording.columns)
    for name, values in fine.items():
        np.testing.assert_array_equal(values, recording.columns[name])
    np.testing.assert_array_equal(rough["fx"], recording.columns["fx"].astype("f4"))
    assert "slider.x" in fine
    assert page["scenes"][run["scene"]] == recording.scene


def test_runs_of_one_scene_share_it() -> None:
    data = page_data([crank(TIMES), crank(TIMES, 3.0), Recording(None, TIMES, {"x": TIMES})], {})
    # The poses as drawn are those of the first time, here the same.
    assert [run["scene"] for run in data["runs"]] == [0, 0, None]


def test_numbers_beyond_single_precision_stay_numbers() -> None:
    run = page_data([Recording(None, TIMES, {"x": 1e300 * TIMES, "y": np.full(11, np.nan)})], {})["runs"][0]
    kinds = {name: block["kind"] for block in run["blocks"] for name in block["names"]}
    assert kinds == {"x": "f8", "y": "f4"}


def test_the_same_run_gives_the_same_bytes() -> None:
    assert page_html(crank(TIMES)) == page_html(crank(TIMES))


def test_no_text_breaks_the_page() -> None:
    plain = crank(TIMES)
    assert plain.scene is not None
    scene = plain.scene | {"description": HOSTILE}
    columns = dict(plain.columns) | {HOSTILE: TIMES}
    recording = Recording(scene, TIMES, columns, {HOSTILE: HOSTILE}, HOSTILE)
    text = page_html(recording, HOSTILE, {"plots": [HOSTILE]})
    parsed = Elements(text)
    assert [tag for tag, *_ in parsed.found].count("script") == 3
    assert next(t for tag, _, t in parsed.found if tag == "title").strip() == " ".join(HOSTILE.split())
    assert "default-src 'none'" in text
    page = data_of(text)
    assert page["runs"][0]["name"] == HOSTILE
    assert page["runs"][0]["units"][HOSTILE] == HOSTILE
    assert page["options"]["plots"] == [HOSTILE]


def test_a_page_is_written_whole_or_not_at_all(tmp_path: Path) -> None:
    file = tmp_path / "new" / "page.html"
    written = write_page(file, crank(TIMES), "A title")
    assert written.path == file
    assert written.size == file.stat().st_size
    before = file.read_bytes()
    with pytest.raises(ViewerError, match="no option 'colour'"):
        write_page(file, crank(TIMES), options={"colour": "red"})
    assert file.read_bytes() == before
    with pytest.raises(FileError, match="is a folder"):
        write_page(tmp_path, crank(TIMES))
    assert sorted(path.name for path in file.parent.iterdir()) == ["page.html"]


def test_the_notes_are_returned_and_stand_in_the_page(tmp_path: Path) -> None:
    recording = crank(np.linspace(0.0, 1.0, 101))
    del recording.columns["slider.x"]
    assert recording.scene is not None
    lacking = Recording(recording.scene, recording.t, recording.columns)
    written = write_page(tmp_path / "p.html", lacking, most=10)
    assert written.notes[0].startswith("10 of 101 times are shown")
    assert written.notes[1] == "slider is not drawn: the result has no column 'slider.x'."
    run = data_of((tmp_path / "p.html").read_text(encoding="utf-8"))["runs"][0]
    assert run["notes"] == written.notes[:1]
    assert run["missing"][0]["name"] == "slider"


def test_a_page_has_as_many_times_as_were_asked_for(tmp_path: Path) -> None:
    """Also more than by default."""
    most = 6000
    written = write_page(tmp_path / "p.html", crank(np.linspace(0.0, 1.0, 12001)), most=most)
    run = data_of(written.path.read_text(encoding="utf-8"))["runs"][0]
    kept = len(numbers(run["time"])["time"])
    assert run["notes"] == written.notes
    assert written.notes[0].startswith(f"{kept} of 12001 times are shown")
    assert 0.9 * most < kept <= most


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"sped": 1.0}, "no option 'sped'; did you mean 'speed'"),
        ({"speed": 100.0}, "'speed' of the player is 100.0; it must be a number from 0.05 to 10."),
        ({"speed": True}, "must be a number"),
        ({"speed": float("nan")}, "must be a number"),
        ({"plots": "angle"}, "must be a list of names of columns"),
        ({"theme": "blue"}, "must be 'auto', 'light' or 'dark'"),
    ],
)
def test_invalid_options_are_refused(options: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ViewerError, match=re.escape(sentence)):
        page_html(crank(TIMES), options=options)


@pytest.mark.parametrize("recordings", [[], [1], ["run"]])
def test_a_folder_without_a_recording_is_refused(recordings: Any) -> None:
    with pytest.raises(ViewerError, match="recording|Recording"):
        page_html(recordings)


def test_a_notebook_gets_the_page_in_a_frame_with_its_size() -> None:
    text = html_of(crank(TIMES), height=300)
    frame = next(attributes for tag, attributes, _ in Elements(text).found if tag == "iframe")
    assert frame["srcdoc"] == page_html(crank(TIMES))
    assert "height:300px" in str(frame["style"])
    assert "This animation takes 0.0 MB of the notebook." in html.unescape(text)
    with pytest.raises(ViewerError, match="height of the frame is 10"):
        html_of(crank(TIMES), height=10)


def test_without_the_script_there_is_one_sentence(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.undo()

    def none() -> Path:
        raise RuntimeError("It is not there.")

    monkeypatch.setattr(html_document, "bundle", none)
    with pytest.raises(ViewerError, match="It is not there."):
        write_page(tmp_path / "p.html", crank(TIMES))
    assert list(tmp_path.iterdir()) == []
