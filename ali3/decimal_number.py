"""Decimal numbers as text."""

from __future__ import annotations

DECIMAL = r"(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?"
"""Pattern of a decimal number without its sign. What `float` takes besides, such as 1_0 or digits of other scripts, is
more often a slip than a number."""
