"""The interface of modules that draw recordings as pages, in notebooks, as glTF files and films."""

import os
from collections.abc import Mapping, Sequence
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any, Protocol, cast

from ali3.scene.errors import ViewerError
from ali3.scene.recording import Recording
from ali3.scene.written_file import WrittenFilm, WrittenGltf, WrittenPage

GROUP = "ali3.drawers"
"""Group of entry points that name modules with the functions of `Drawer`."""


class Drawer(Protocol):
    """A module that draws recordings; its functions are documented in `viewer.drawer`."""

    def check_options(self, options: Mapping[str, Any], /) -> dict[str, Any]: ...

    def html_of(self, recordings: Recording | Sequence[Recording], /, *, options: Mapping[str, Any] = ...) -> str: ...

    def show(self, recordings: Sequence[Recording], options: Mapping[str, Any], /) -> Path: ...

    def write_page(
        self, path: str | os.PathLike[str], recordings: Sequence[Recording], /, *, options: Mapping[str, Any]
    ) -> WrittenPage: ...

    def write_gltf(self, path: str | os.PathLike[str], recording: Recording, /, **settings: Any) -> WrittenGltf: ...

    def write_mp4(
        self, path: str | os.PathLike[str], recordings: Sequence[Recording], /, **settings: Any
    ) -> WrittenFilm: ...


def drawer() -> Drawer:
    """The installed drawer. Raises `ViewerError` if there is none."""
    for point in entry_points(group=GROUP):
        return cast(Drawer, point.load())
    raise ViewerError('No viewer is installed; pip install "ali3[viewer]" in the folder of its source.')
