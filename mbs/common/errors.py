"""Errors of models and of their arguments."""

from __future__ import annotations


class ModelError(ValueError):
    """A model that cannot be: one sentence that names the part, the value and what would be right."""


class ArgumentTypeError(TypeError, ValueError):
    """An argument that is a thing of another kind: one sentence that says which kind is needed.

    It is a TypeError, as everywhere in Python, and a ValueError, as all errors of values here.
    """
