"""Pictures of a report."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

from matplotlib.figure import Figure
from PIL import Image

from ali3.charts import save_pictures
from ali3.files import whole_file
from ali3.html_elements import picture

if TYPE_CHECKING:
    from lxml.html import HtmlElement


class Pictures:
    """PNG and SVG files of a folder; the former stand in the report too."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def add(self, figure: Figure, name: str, what: str) -> HtmlElement:
        """Write a figure, and give its place in the page."""
        _, file = save_pictures(figure, self.folder / re.sub(r"[^A-Za-z0-9]+", "_", name).strip("_")[:80])
        with Image.open(file) as drawn, whole_file(file) as made:
            # A palette: lines in many colours take a third of the bytes, and look the same.
            drawn.convert("RGB").quantize(256, Image.Quantize.FASTOCTREE).save(made, optimize=True)
        return picture(file.read_bytes(), what)
