"""Pictures of charts are drawn where tests look at them.

Laying out and drawing one takes half a second, a comparison four of them. All that the hosts plot goes into figures in
every test; a picture of one point stands for what matplotlib makes of them, but in tests with the marker `drawn`.
"""

from __future__ import annotations

import base64
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any

import pytest
from matplotlib.figure import Figure

_SVG = b'<svg xmlns="http://www.w3.org/2000/svg" width="1" height="1"></svg>'
_PNG = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmMIQAAAABJRU5ErkJggg=="
)
_drawn = pytest.StashKey[bool]()


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Before fixtures, which may draw too."""
    item.config.stash[_drawn] = item.get_closest_marker("drawn") is not None


@pytest.fixture(scope="session", autouse=True)
def _one_point_for_a_chart(request: pytest.FixtureRequest) -> Iterator[None]:
    save = Figure.savefig

    def written(figure: Figure, file: str | Path | IO[bytes], **options: Any) -> None:
        if request.config.stash[_drawn]:
            save(figure, file, **options)
            return
        content = _SVG if options.get("format") == "svg" else _PNG
        if isinstance(file, (str, Path)):
            Path(file).write_bytes(content)
        else:
            file.write(content)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Figure, "savefig", written)
        yield
