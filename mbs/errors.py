"""The error of the modelling vocabulary."""

from __future__ import annotations


class ModelError(ValueError):
    """A model that cannot be: one sentence that names the part, the value and what would be right."""
