"""Looks of the materials of a scene in glTF; the same as in the page."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Look:
    """A physically based material."""

    name: str
    """Of the kind."""
    color: tuple[float, float, float, float]
    """Linear red, green, blue, and opacity."""
    metalness: float
    roughness: float
    """`metalness`, `roughness`: 0 to 1."""
    clearcoat: tuple[float, float] | None = None
    """Factor and roughness."""
    double: bool = False
    """Seen from both sides."""


LOOKS: dict[str, Any] = json.loads(Path(__file__).parents[1].joinpath("looks.json").read_text(encoding="utf-8"))
"""Materials by name, and the colours of stress; the page has the same."""


def linear(color: str) -> tuple[float, float, float]:
    """Linear parts of a colour ``#rrggbb``, which is in sRGB."""
    parts = [int(color[k : k + 2], 16) / 255.0 for k in (1, 3, 5)]
    r, g, b = (x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4 for x in parts)
    return r, g, b
