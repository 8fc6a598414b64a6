"""Every scene with a film: its bodies are drawn where the run has them, at all times."""

from typing import Any

import numpy as np
import pytest

from ali3.scene.recording import Recording
from benchmarks.pictures.animations import ANIMATIONS
from tests.viewer.poses import FramePoses

# They have the car of the lane change.
SCENES = [name for name in ANIMATIONS if name not in ("drop", "proving_ground")]
FEW = ("slider_crank", "bricard", "kerb_test")  # in the plane, in space, a car that bends; the others in the proof run
INSTANTS = 12  # that the page looks at to fit its picture
_SCAN = """([rows]) => view.scan(i => name => rows[i][name], rows.length)"""
_SEEN = ("box", "sphere", "cylinder", "tube", "plate")


def known_points(scene: dict[str, Any]) -> list[list[Any]]:
    """An anchor inside each shape, or two that it is the middle of."""
    results = []
    for shape in scene["shapes"]:
        if shape["kind"] in ("box", "sphere"):
            results.append([[shape["frame"], shape.get("at") or [0, 0, 0]]])
        elif shape["kind"] == "cylinder":
            results.append([[shape["frame"], end] for end in shape["ends"]])
        elif shape["kind"] == "tube":
            results.append(shape["points"][:2])
        else:
            results.append(shape["points"][:3])
    return results


def magenta(picture: np.ndarray) -> np.ndarray:
    """Where a picture has the colour that all shapes were given, in light or in shadow."""
    r, g, b = (picture[..., k] for k in range(3))
    return (r > g + 25) & (b > g + 25)


def plain(recording: Recording) -> dict[str, Any]:
    """The scene with its simple shapes in one colour, and nothing that could hide them."""
    shapes = [s | {"color": "#ff00ff", "material": "plastic"} for s in recording.scene["shapes"] if s["kind"] in _SEEN]
    for shape in shapes:
        shape.pop("opacity", None)
    return recording.scene | {"shapes": shapes, "arrows": [], "flexible": [], "missing": []}


@pytest.mark.slow
@pytest.mark.parametrize("name", [pytest.param(s, marks=[pytest.mark.proof] * (s not in FEW)) for s in SCENES])
def test_bodies_are_drawn_where_they_are(drawn, recorded, name):
    film = ANIMATIONS[name]
    recording = recorded(name)
    assert recording.missing == []
    scene = plain(recording)
    t = recording.t
    rows = [
        {column: float(values[k]) for column, values in recording.columns.items()}
        for k in np.searchsorted(t, np.linspace(film.begin, film.end, INSTANTS)).clip(0, len(t) - 1)
    ]
    poses = FramePoses(scene, {column: np.array([row[column] for row in rows]) for column in rows[0]}, INSTANTS)
    points = [np.mean([poses.points(anchor) for anchor in anchors], axis=0) for anchors in known_points(scene)]
    assert points, "no shape of this scene is looked at"
    drawn.show(scene, rows[0], words=False)
    drawn.ask(_SCAN, [rows])
    moved, first = 0.0, None
    for k in (0, INSTANTS // 3, INSTANTS - 1):
        drawn.update(rows[k])
        seen = magenta(drawn.picture())
        places = np.array(drawn.project_all(point[k] for point in points))
        assert (places >= 0).all()
        assert (places < [320, 180]).all()
        for x, y in places.astype(int):
            around = seen[max(y - 2, 0) : y + 3, max(x - 2, 0) : x + 3]
            assert around.any(), f"nothing is drawn at {x}, {y} at instant {k}"
        first = places if first is None else first
        moved = max(moved, float(np.abs(places - first).max()))
    assert scene.get("focus") or moved > 3.0, "nothing moved"
