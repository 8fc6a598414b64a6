"""model.png: curves of a run drawn into a small picture, without a plotting library, so that its bytes repeat."""

import struct
import zlib

import numpy as np
from numpy.typing import NDArray

_WIDTH, _HEIGHT, _EDGE = 200, 150, 12
_COLOURS = ((31, 90, 150), (200, 80, 40), (60, 140, 70))
_FINE = 8


def curves_png(t: NDArray[np.float64], curves: list[NDArray[np.float64]]) -> bytes:
    """Draw up to three curves, each scaled to its own range.

    Parameters
    ----------
    t : ndarray, shape (n,)
        Times, ascending.
    curves : list of ndarray, shape (n,)
        Values at these times.

    Returns
    -------
    bytes
        A PNG of 200 x 150 pixels.
    """
    pixels = np.full((_HEIGHT, _WIDTH, 3), 255, dtype=np.uint8)
    pixels[_EDGE : _HEIGHT - _EDGE, _EDGE] = 120
    pixels[_HEIGHT - _EDGE, _EDGE : _WIDTH - _EDGE] = 120
    columns = np.arange(_FINE * (_WIDTH - 2 * _EDGE)) / _FINE
    for colour, curve in zip(_COLOURS, curves, strict=False):
        low, high = float(curve.min()), float(curve.max())
        span = high - low if high > low else 1.0
        times = t[0] + (t[-1] - t[0]) * columns / columns[-1]
        height = (np.interp(times, t, curve) - low) / span
        rows = np.rint(_HEIGHT - _EDGE - 4 - height * (_HEIGHT - 2 * _EDGE - 8)).astype(int)
        x = _EDGE + columns.astype(int)
        for offset in (0, 1):
            pixels[rows + offset, x] = colour
    return _png(pixels)


def _png(pixels: NDArray[np.uint8]) -> bytes:
    height, width, _ = pixels.shape
    lines = b"".join(b"\0" + row.tobytes() for row in pixels)
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    chunks = ((b"IHDR", header), (b"IDAT", zlib.compress(lines, 9)), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)) for kind, data in chunks
    )
