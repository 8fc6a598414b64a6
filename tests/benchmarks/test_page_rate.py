"""`python -m benchmarks.pictures rates`: a figure for every scene and quality, printed and in the file."""

import json

import pytest

pytest.importorskip("playwright")

from benchmarks.pictures import __main__ as pictures
from benchmarks.pictures import page_rate
from tests.in_browser import chromium_or_skip


@pytest.mark.proof
def test_the_rate_of_every_scene_is_printed_and_kept(tmp_path, capsys):
    chromium_or_skip()
    file = tmp_path / "rate.json"
    assert pictures.main(["rates", "--pictures", "1", "--json", str(file)]) == 0
    rows = json.loads(file.read_text(encoding="utf-8"))["rows"]
    assert [(row["scene"], row["quality"]) for row in rows] == [
        (scene, quality) for scene in page_rate.SCENES for quality in page_rate.QUALITIES
    ]
    assert all(row["ms"] > 0 and row["triangles"] > 1000 for row in rows)
    assert all(64 * row["calls"] / 4 < row["bytes"] < 1e6 for row in rows), "matrices, and no meshes or textures"
    assert "ms: median of a picture" in capsys.readouterr().out
