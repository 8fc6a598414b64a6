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

from ali3.chart_description import describe, make_plain, save_figure
from ali3.files import atomic_file, write_bytes
from ali3.message_text import clean

_PIXELS_PER_INCH = 96  # of CSS
_DOTS_PER_INCH = 150  # of parts of an SVG that are drawn as pixels
MANY_POINTS = 200
"""A curve with more markers is better drawn as pixels (``rasterized``): each marker takes about 80 bytes of SVG."""


@dataclass(frozen=True)
class Drawing:
    """A figure as SVG."""

    svg: bytes
    words: str
    """Alternative text, which is also the title in the SVG."""
    size: tuple[int, int]
    """Width and height, CSS pixels."""

    def write(self, file: Path) -> Path:
        """Write the SVG to a file and return its path."""
        write_bytes(file, self.svg)
        return file


@contextlib.contextmanager
def _ignore_layout_warning() -> Iterator[None]:
    """Ignore the warning that texts from files are too long for the layout."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "constrained_layout not applied", UserWarning)
        yield


def drawing(figure: Figure, message: str) -> Drawing:
    """Draw a figure as SVG, and close it; the same figure gives the same bytes.

    `message`: alternative text; empty: the title of the figure.
    """
    content = io.BytesIO()
    make_plain(figure)
    figure_text = describe(figure)
    alternative_text = message or figure_text.partition("\n")[0]
    title, description = escape(clean(alternative_text)), escape(figure_text)
    figure.set_dpi(_DOTS_PER_INCH)
    with plt.rc_context({"svg.hashsalt": "ali3"}), _ignore_layout_warning():
        # `savefig` would draw the figure and its layout twice.
        canvas: Any = FigureCanvasSVG(figure)
        canvas.print_svg(content, metadata={"Date": None, "Creator": None})
    plt.close(figure)
    width, height = (round(_PIXELS_PER_INCH * length) for length in figure.get_size_inches())
    # matplotlib writes no description, and screen readers ignore a drawing without a role.
    prolog, root, remainder = content.getvalue().partition(b"<svg ")
    tag, _, elements = remainder.partition(b">")
    accessible_text = f' role="img">\n <title>{title}</title>\n <desc>{description}</desc>'.encode()
    return Drawing(prolog + root + tag + accessible_text + elements, alternative_text, (width, height))


def save_picture(figure: Figure, file: Path) -> None:
    """Write a figure as PNG with its description, and close it; the same figure gives the same bytes."""
    with atomic_file(file) as temporary, _ignore_layout_warning():
        save_figure(figure, temporary)
    plt.close(figure)
