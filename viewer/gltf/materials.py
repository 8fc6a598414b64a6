"""Looks of the materials of a scene in glTF; the same as in the page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Look:
    """A physically based material.

    Parameters
    ----------
    name : str
        Of the kind.
    color : (float, float, float, float)
        Linear red, green, blue, and opacity.
    metalness, roughness : float
        0 to 1.
    clearcoat : (float, float) or None
        Factor and roughness.
    double : bool
        Seen from both sides.
    """

    name: str
    color: tuple[float, float, float, float]
    metalness: float
    roughness: float
    clearcoat: tuple[float, float] | None = None
    double: bool = False


@dataclass(frozen=True)
class Kind:
    """What a material has where the shape says nothing."""

    color: str
    metalness: float
    roughness: float
    opacity: float = 1.0
    clearcoat: tuple[float, float] | None = None


KINDS = {
    "steel": Kind("#8f979e", 0.85, 0.42),
    "paint": Kind("#a5271f", 0.15, 0.45, clearcoat=(0.8, 0.12)),
    "dark_paint": Kind("#23282d", 0.2, 0.5, clearcoat=(0.3, 0.3)),
    "rubber": Kind("#17181a", 0.0, 0.88),
    "rim": Kind("#b9bec4", 0.9, 0.28),
    "glass": Kind("#8fb0bf", 0.0, 0.05, 0.28),
    "plastic": Kind("#4c7ba6", 0.0, 0.5),
    "chrome": Kind("#dfe3e6", 1.0, 0.12),
}
"""By name."""


def look(shape: Mapping[str, Any], other: str = "plastic", color: str | None = None, double: bool = False) -> Look:
    """The material of a shape.

    Parameters
    ----------
    shape : mapping
        May have ``material``, ``color`` and ``opacity``.
    other : str
        Kind where it names none.
    color : str, optional
        Where it names none.
    double : bool
        Seen from both sides.
    """
    name = shape.get("material") or other
    kind = KINDS[name]
    opacity = shape.get("opacity")
    shade = linear(shape.get("color") or color or kind.color)
    return Look(
        name,
        (*shade, float(kind.opacity if opacity is None else opacity)),
        kind.metalness,
        kind.roughness,
        kind.clearcoat,
        double,
    )


def linear(color: str) -> tuple[float, float, float]:
    """Linear parts of a colour ``#rrggbb``, which is in sRGB."""
    parts = [int(color[k : k + 2], 16) / 255.0 for k in (1, 3, 5)]
    r, g, b = (x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4 for x in parts)
    return r, g, b
