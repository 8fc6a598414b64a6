"""Films of the scenes: the command writes the files that it reports, and the documentation shows all of them."""

from pathlib import Path

import pytest
from PIL import Image

from benchmarks.pictures import __main__ as pictures
from benchmarks.pictures.animations import ANIMATIONS, FPS, SIZE
from tests.in_browser import chromium_or_skip

DOCS = Path(__file__).parents[2] / "docs"
LARGEST, ALL = 1_300_000, 10_500_000  # bytes


@pytest.mark.parametrize("name", ANIMATIONS)
def test_the_documentation_has_every_film(name):
    film = ANIMATIONS[name]
    path = DOCS / "images" / "animations" / f"{name}.webp"
    assert f"](images/animations/{name}.webp)" in (DOCS / "scenes.md").read_text(encoding="utf-8")
    assert path.stat().st_size < LARGEST
    with Image.open(path) as file:
        assert file.size == SIZE
        # equal pictures that follow each other are one
        assert 0.5 < file.n_frames / ((film.end - film.begin) / film.speed * FPS) < 1.1


def test_the_films_are_small():
    files = list((DOCS / "images" / "animations").iterdir())
    assert {file.stem for file in files} == set(ANIMATIONS)
    assert sum(file.stat().st_size for file in files) < ALL


@pytest.mark.slow
def test_the_command_films(tmp_path, capsys):
    chromium_or_skip()
    assert pictures.main(["films", "--out", str(tmp_path / "films"), "--only", "pendulum"]) == 0
    output = capsys.readouterr().out
    assert "pendulum.webp  61 pictures, 4.1 s" in output
    with Image.open(tmp_path / "films" / "pendulum.webp") as file:
        assert file.n_frames > 30
