"""A summary that fits a slide: what it says ends on it."""

from __future__ import annotations

from pathlib import Path

import pytest
from matplotlib.figure import Figure

from hosts.run import slide


def test_a_long_subtitle_ends_on_the_slide(monkeypatch: pytest.MonkeyPatch) -> None:
    """That of a study of every test of the catalogue ran over the edge."""
    made: list[Figure] = []
    monkeypatch.setattr(slide, "save_pictures", lambda figure, stem: made.append(figure) or [])
    for tests in (1, 40):
        slide.write_slide(Path("s"), "Study", ", ".join(tests * ["braking_in_a_turn"]), ["measure"], [["load"]], [])
    short, long = (figure.texts[1] for figure in made)
    assert short.get_text() == "braking_in_a_turn"
    assert long.get_text().endswith("braking_in_a_turn, ...")
    for text in (short, long):
        assert text.get_window_extent().x1 < made[0].bbox.x1
