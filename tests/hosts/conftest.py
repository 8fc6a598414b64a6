"""Pictures of charts are drawn where tests look at them.

Laying out and drawing one takes half a second, a comparison four of them. All that the hosts plot goes into figures in
every test; a picture of one point stands for what matplotlib makes of them, but in tests with the marker `drawn`.
"""

import base64
from collections.abc import Callable, Generator
from pathlib import Path
from typing import IO, Any

import pytest
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

from tests.hosts.in_this_process import in_this_process

HERE = Path(__file__).resolve().parent
_SVG = b'<svg xmlns="http://www.w3.org/2000/svg" width="1" height="1"></svg>'
_PNG = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmMIQAAAABJRU5ErkJggg=="
)


def _one_point(of: Figure | FigureCanvasSVG, file: str | Path | IO[bytes], **options: Any) -> None:
    content = _SVG if options.get("format") == "svg" or isinstance(of, FigureCanvasSVG) else _PNG
    if isinstance(file, (str, Path)):
        Path(file).write_bytes(content)
    else:
        file.write(content)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Generator[None, object, object]:
    """Around a test of this folder with its fixtures, which may draw too."""
    if HERE not in item.path.parents or item.get_closest_marker("drawn") is not None:  # workers of xdist call all
        return (yield)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Figure, "savefig", _one_point)
        patch.setattr(FigureCanvasSVG, "print_svg", _one_point)
        return (yield)


@pytest.fixture(scope="session")
def tuned(scene_fmu: Callable[..., Path]) -> Path:
    """The FMU of a mass on a spring whose values can be set."""
    return scene_fmu(f"{HERE / 'scenes.py'}:tuned")


@pytest.fixture
def in_process() -> Generator[pytest.MonkeyPatch]:
    """FMUs are driven by the process of the test, until `undo`."""
    with in_this_process() as patch:
        yield patch
