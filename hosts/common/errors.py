"""The error a host shows to its user as one sentence."""

from __future__ import annotations

from ali3.errors import UserError


class HostError(UserError):
    """Something the user can put right; the message says what."""
