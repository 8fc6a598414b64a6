"""The warning about a closed loop that changed its assembly mode."""

from __future__ import annotations


class BranchWarning(UserWarning):
    """A closed loop changed its assembly mode: which one, when and what to do."""
