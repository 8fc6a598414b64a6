"""Arrays of a scene as text: base64 of little-endian numbers of 4 bytes, row by row."""

from __future__ import annotations

import base64
import binascii
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray


def encoded(values: ArrayLike, kind: str = "f") -> str:
    """Base64 of numbers.

    Parameters
    ----------
    values : array_like
        Of any shape.
    kind : str
        ``"f"``: float32, or ``"u"``: uint32.
    """
    return base64.b64encode(np.ascontiguousarray(values, dtype=f"<{kind}4").tobytes()).decode("ascii")


def decoded(text: str, kind: str) -> NDArray[Any]:
    """Numbers of a text in base64; `ValueError` if it is none.

    Parameters
    ----------
    text : str
        base64 of little-endian numbers of 4 bytes.
    kind : str
        ``"f"`` or ``"u"``.
    """
    try:
        data = base64.b64decode(text, validate=True)
    except (binascii.Error, ValueError):
        raise ValueError("is not base64") from None
    if len(data) % 4:
        raise ValueError(f"has {len(data)} bytes, which is no multiple of 4")
    return np.frombuffer(data, f"<{kind}4")
