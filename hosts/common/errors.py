"""The error a host shows to its user as one sentence."""

from ali3.command_run import NOT_GOOD
from ali3.errors import UserError


class HostError(UserError):
    """Something the user can put right; the message says what."""


class FailedFmuError(HostError):
    """The FMU has failed: its process has ended, or a value is not a number; the sentence says when and where."""

    status = NOT_GOOD
