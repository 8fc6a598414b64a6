"""The public name of recordings."""

from __future__ import annotations

from ali3.scene.recording import Recording

__all__ = ["Recording"]
