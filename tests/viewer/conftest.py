"""Recordings of films, and a page with one view."""

import io
import pickle
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ali3.scene.recording import Recording
from viewer import bundle

_MAKE = """([scene, options]) => {
  window.view?.dispose();
  window.view = new ALi3Viewer.SceneView(document.getElementById('picture'), scene, options);
}"""
_NUMBERS = "numbers => view.update(numbers === null ? null : name => numbers[name])"


class DrawnPage:
    """A page with a `SceneView` called `view`, which is rendered once for all that is asked of it at given numbers."""

    def __init__(self, page: Any):
        self._page, self._late = page, False
        self.errors: list[str] = []
        page.on("pageerror", lambda error: self.errors.append(str(error)))

    @property
    def page(self) -> Any:
        if self._late:
            self._page.evaluate("view.render()")
        self._late = False
        return self._page

    def show(self, scene: dict[str, Any], numbers: dict[str, float] | None = None, **options: Any) -> None:
        """Draw a scene, as drawn or at given numbers."""
        self._page.evaluate(_MAKE, [scene, options])
        self._late = False
        self.update(numbers)

    def update(self, numbers: dict[str, float] | None) -> None:
        self.page.evaluate(_NUMBERS, numbers)
        self._late = True

    def ask(self, code: str, *values: Any) -> Any:
        """Value of a JavaScript expression of `view`, or of a function applied to one value."""
        return self.page.evaluate(code, *values)

    def picture(self) -> np.ndarray:
        """Pixels (height, width, 3) from 0 to 255, without the texts over them."""
        from PIL import Image

        self._page.evaluate("() => { document.body.className = 'hidden'; view.render(); }")
        self._late = False
        picture = self._page.screenshot()
        self.page.evaluate("document.body.className = ''")
        return np.asarray(Image.open(io.BytesIO(picture)).convert("RGB")).astype(int)

    def project(self, point: Any) -> tuple[float, float]:
        return tuple(self._page.evaluate("point => view.project(point)", [float(x) for x in point]))

    def project_all(self, points: Any) -> list[list[float]]:
        """Pixels of many points, asked for at once."""
        listed = [[float(x) for x in point] for point in points]
        return list(self._page.evaluate("points => points.map(point => view.project(point))", listed))


@pytest.fixture(scope="module")
def _page(chromium: Any) -> Iterator[Any]:
    page = chromium.new_page(viewport={"width": 320, "height": 180})
    page.set_content("<body style='margin:0'><div id='picture' style='width:320px;height:180px'></div></body>")
    page.add_style_tag(content=".hidden .a3-notes { display: none }")
    page.add_script_tag(content=bundle.bundle().read_text(encoding="utf-8"))
    yield page
    page.close()


@pytest.fixture
def drawn(_page: Any) -> Iterator[DrawnPage]:
    """An empty page of 320 x 180 pixels; an error in its script fails the test."""
    page = DrawnPage(_page)
    yield page
    page.page.evaluate("window.view?.dispose(); window.view = undefined;")
    assert page.errors == []


@pytest.fixture(scope="session")
def lane_change(made_once: Callable[[str, Callable[[Path], None]], Path]) -> Recording:
    """A double lane change of the prototype."""
    from benchmarks.car import manoeuvres

    run = lambda: manoeuvres.run("double_lane_change", 0.002, car=manoeuvres.PROTOTYPE, every=5)  # noqa: E731
    return _kept(made_once, "double_lane_change", lambda: run().recording())


@pytest.fixture(scope="session")
def live_car(scene_fmu: Callable[..., Path]) -> Path:
    """The rigid prototype, for pages too."""
    return scene_fmu("prototype_car", wasm=True)


@pytest.fixture(scope="session")
def live_reach(scene_fmu: Callable[..., Path]) -> Path:
    """A mass on a rod and a cable that a winch pulls beyond its reach, if it is told to; for pages too."""
    return scene_fmu(f"{Path(__file__).parents[1] / 'fmu' / 'scenes.py'}:sprung_reach", wasm=True)


@pytest.fixture(scope="session")
def recorded(made_once: Callable[[str, Callable[[Path], None]], Path]) -> Callable[[str], Recording]:
    """The run of a film, driven once for all tests that look at it."""
    from benchmarks.pictures.animations import ANIMATIONS  # takes a second, which other pages do not need

    return lambda name: _kept(made_once, name, ANIMATIONS[name].record)


def _kept(
    made_once: Callable[[str, Callable[[Path], None]], Path], name: str, record: Callable[[], Recording]
) -> Recording:
    """A recording that is made once for all processes."""

    def fill(folder: Path) -> None:
        (folder / "run").write_bytes(pickle.dumps(record()))

    return pickle.loads((made_once(f"recording_{name}", fill) / "run").read_bytes())
