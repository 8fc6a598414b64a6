"""Arrays of a scene as text: base64 of little-endian numbers of 4 bytes, or of single bytes, row by row."""

import base64
import binascii
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray


def encoded(values: ArrayLike, kind: str = "f") -> str:
    """Base64 of numbers of any shape. `kind`: ``"f"`` for float32, ``"u"`` for uint32."""
    return base64.b64encode(np.ascontiguousarray(values, dtype=f"<{kind}4").tobytes()).decode("ascii")


def decoded(text: str, kind: str) -> NDArray[Any]:
    """Numbers of a text that `encoded` wrote. Raises `ValueError`, whose message is a predicate, for other texts."""
    data = _bytes(text)
    if len(data) % 4:
        raise ValueError(f"has {len(data)} bytes, which is not a multiple of 4")
    return np.frombuffer(data, f"<{kind}4")


def encoded_octets(values: ArrayLike) -> str:
    """Base64 of whole numbers from 0 to 255, of any shape."""
    return base64.b64encode(np.ascontiguousarray(values, dtype=np.uint8).tobytes()).decode("ascii")


def octets(text: str) -> NDArray[np.uint8]:
    """Whole numbers from 0 to 255 of a text in base64. Raises `ValueError` if the text is not base64."""
    return np.frombuffer(_bytes(text), np.uint8)


def _bytes(text: str) -> bytes:
    try:
        return base64.b64decode(text, validate=True)
    except (binascii.Error, ValueError):
        raise ValueError("is not base64") from None
