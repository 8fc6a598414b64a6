"""The public names of the checks of a scene."""

from __future__ import annotations

from ali3.scene.scene import check_scene, read_scene

__all__ = ["check_scene", "read_scene"]
