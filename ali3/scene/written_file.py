"""The result of writing a recording to a file: path, size and notes."""

from pathlib import Path
from typing import NamedTuple


class WrittenPage(NamedTuple):
    """A page that was written."""

    path: Path
    size: int
    """Bytes."""
    notes: list[str]
    """Sentences: thinning, gaps, what is not drawn. They stand in the page too."""


class WrittenFilm(NamedTuple):
    """A film that was written."""

    path: Path
    size: int
    """Bytes."""
    frames: int
    """Pictures."""
    duration: float
    """Of the film, s."""
    notes: list[str]
    """Sentences: thinning, gaps, what is not drawn."""


class WrittenGltf(NamedTuple):
    """A glTF file that was written."""

    path: Path
    size: int
    """Bytes."""
    times: int
    """Of the recording that were kept."""
    position_error: float
    """Largest distance of a drawn point between the kept times from where it was recorded, mm."""
    angle_error: float
    """The same for the orientation, degrees."""
    notes: list[str]
    """Sentences: what is not drawn, or drawn in another way."""
