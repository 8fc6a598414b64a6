"""Solids of which a shape is put together, about y, from the table that the page has too (`shapes.json`)."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from viewer import solids
from viewer.solids import Solid

SHAPES: dict[str, Any] = json.loads(Path(__file__).with_name("shapes.json").read_text(encoding="utf-8"))
"""Parts of wheels and steering wheels, and the shares of dampers and springs."""

Part = Mapping[str, Any]
Lengths = Mapping[str, float]


def composed(parts: list[Part], lengths: Lengths, out: float = 0.0) -> Iterator[tuple[Part, Solid]]:
    """Parts with their solids.

    `parts`: of `SHAPES`; `lengths`: of the shape by the names that the table has for them, m; `out`: side that the
    shape stands on along y: 1, -1, or 0 in the middle.
    """
    for part in parts:
        beside, middle = part.get("y", (0.0, [0.0]))
        made = _MAKERS[part["kind"]](part, lengths)
        for height in [beside * out] if out else middle:
            for degrees in part.get("angles", (0.0,)):
                turn = _about_y(math.radians(degrees))
                at = part.get("x", 0.0) * lengths[part["across"]] * turn[:, 0]
                at[1] = height * lengths[part["along"]]
                yield part, made.placed(turn, at)


def _lathe(part: Part, lengths: Lengths) -> Solid:
    across, along = lengths[part["across"]], lengths[part["along"]]
    begin = lengths[part["from"]] if "from" in part else 0.0
    points = [(begin + r * across, y * along) for r, y in part["profile"]]
    if part.get("mirrored"):
        points = [*((r, -y) for r, y in points), *points[-2::-1]]
    return solids.lathe(points, part["turns"])


def _box(part: Part, lengths: Lengths) -> Solid:
    across, along = lengths[part["across"]], lengths[part["along"]]
    return solids.box([s * by for s, by in zip(part["size"], (across, along, across), strict=True)])


def _sphere(part: Part, lengths: Lengths) -> Solid:
    return solids.sphere(part["radius"] * lengths[part["across"]], 8)


def _ring(part: Part, lengths: Lengths) -> Solid:
    across = lengths[part["across"]]
    size = part["radius"] * across, part["thickness"] * across
    return solids.torus(*size, part["turns"], part["sides"], part.get("arc"))


_MAKERS: dict[str, Callable[[Part, Lengths], Solid]] = {"lathe": _lathe, "box": _box, "sphere": _sphere, "ring": _ring}


def _about_y(angle: float) -> solids.Array:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
