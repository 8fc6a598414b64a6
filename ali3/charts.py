"""How charts are written."""

from __future__ import annotations

import contextlib
import warnings
from collections.abc import Iterator
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot as plt
from matplotlib.figure import Figure

from ali3.chart_words import png_metadata
from ali3.files import whole_file


@contextlib.contextmanager
def _however_long() -> Iterator[None]:
    """Texts of strangers may be too long to be laid out: the picture is drawn all the same."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "constrained_layout not applied", UserWarning)
        yield


def save_picture(figure: Figure, file: Path) -> None:
    """Write a figure as PNG, with what it shows in words, and close it; the same figure gives the same bytes."""
    with whole_file(file) as made, _however_long():
        figure.savefig(made, dpi=110, metadata=png_metadata(figure))
    plt.close(figure)


def save_pictures(figure: Figure, stem: Path) -> list[Path]:
    """Write a figure as SVG and as PNG, ``stem`` with these suffixes, and close it."""
    files = [stem.with_name(f"{stem.name}{suffix}") for suffix in (".svg", ".png")]
    # the same drawing gives the same bytes
    with plt.rc_context({"svg.hashsalt": "ali3"}), whole_file(files[0]) as made, _however_long():
        figure.savefig(made, format="svg", metadata={"Date": None, "Creator": None})
    save_picture(figure, files[1])
    return files
