"""Warning about a closed loop that changed its assembly mode."""

from __future__ import annotations


class BranchWarning(UserWarning):
    """A closed loop changed its assembly mode; the message names the loop, the time and a remedy."""
