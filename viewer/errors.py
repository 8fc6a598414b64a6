"""The public names of errors of what is drawn, and what helps where the page that draws is missing."""

from ali3.scene.errors import SceneError, ViewerError

__all__ = ["REMEDY", "SceneError", "ViewerError"]

REMEDY = 'pip install "ali3[viewer]"'
