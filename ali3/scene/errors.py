"""Errors in scenes and recordings, each one sentence for the user."""

from ali3.errors import UserError


class ViewerError(UserError, ValueError):
    """Something cannot be drawn or shown; the message says what, and what would be right."""


class SceneError(ViewerError):
    """A scene is not of the format; the message names the place, the value and what would be right."""
