"""Force elements by name: thin wrappers around the records of `mbs.elements`."""

from __future__ import annotations

from mbs.model.core import ModelCore


class ForceVocabulary(ModelCore):
    """Springs, forces and torques of a model."""
