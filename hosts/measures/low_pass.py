"""Low-pass filter for recorded signals, as measured ones are filtered before they are compared."""

from __future__ import annotations

from ali3.low_pass import low_pass

__all__ = ["low_pass"]
