"""Errors in scenes and recordings, each one sentence for the user."""

from ali3.errors import UserError


class ViewerError(UserError, ValueError):
    """Something cannot be drawn; the message says why, and what would be right."""


class SceneError(ViewerError):
    """A scene has another format; the message names the location, the value and what would be right."""
