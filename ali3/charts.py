"""Writes charts of matplotlib as SVG or PNG files."""

import contextlib
import io
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot as plt
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

from ali3.chart_description import described, png_metadata
from ali3.files import atomic_file
from ali3.message_text import clean

_PIXELS = 96  # of CSS, an inch
_DOTS = 150  # an inch, of what a drawing has as dots
MANY_POINTS = 200
"""More markers than these of one curve are better drawn as dots (``rasterized``): each is some 80 bytes of SVG."""


@dataclass(frozen=True)
class Drawing:
    """A figure, drawn as SVG."""

    svg: bytes
    words: str
    """What it shows, for who cannot see it."""
    size: tuple[int, int]
    """Width and height, CSS pixels."""

    def write(self, file: Path) -> Path:
        """Write it; gives the file."""
        with atomic_file(file) as temporary:
            temporary.write_bytes(self.svg)
        return file


@contextlib.contextmanager
def _however_long() -> Iterator[None]:
    """Texts of strangers may be too long to be laid out: the picture is drawn all the same."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "constrained_layout not applied", UserWarning)
        yield


def drawing(figure: Figure, message: str) -> Drawing:
    """Draw a figure as SVG, and close it; the same figure gives the same bytes.

    `message`: what it shows, in a sentence; its title in the file, which tells what each panel shows too; empty: as the
    figure is titled.
    """
    content = io.BytesIO()
    figure_text = described(figure)
    title, description = (escape(clean(text)) for text in (message or figure_text.partition("\n")[0], figure_text))
    figure.set_dpi(_DOTS)
    with plt.rc_context({"svg.hashsalt": "ali3"}), _however_long():
        # once: savefig draws a figure and its layout twice
        canvas: Any = FigureCanvasSVG(figure)
        canvas.print_svg(content, metadata={"Date": None, "Creator": None})
    plt.close(figure)
    width, height = (round(_PIXELS * length) for length in figure.get_size_inches())
    # matplotlib writes a title, but no description, and screen readers read neither of a drawing without a role.
    prolog, root, remainder = content.getvalue().partition(b"<svg ")
    tag, _, elements = remainder.partition(b">")
    accessible_text = f' role="img">\n <title>{title}</title>\n <desc>{description}</desc>'.encode()
    return Drawing(prolog + root + tag + accessible_text + elements, message, (width, height))


def save_picture(figure: Figure, file: Path) -> None:
    """Write a figure as PNG, with what it shows in words, and close it; the same figure gives the same bytes."""
    with atomic_file(file) as temporary, _however_long():
        figure.savefig(temporary, dpi=110, metadata=png_metadata(figure))
    plt.close(figure)
