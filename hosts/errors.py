"""The error a host shows to its user as one sentence."""

from __future__ import annotations


class HostError(Exception):
    """Something the user can put right; the message says what."""
