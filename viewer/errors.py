"""The public names of errors of scenes and recordings, and advice if the scripts of the page are missing."""

from ali3.scene.errors import SceneError, ViewerError

__all__ = ["REMEDY", "SceneError", "ViewerError"]

REMEDY = 'pip install "ali3[viewer]"'
