"""Errors that a command shows to its user as one sentence."""


class UserError(Exception):
    """An error that the user can correct; the message says how."""

    status = 2
    """Exit code of a command that this error ends."""


class FileError(UserError, OSError):
    """A file or folder that cannot be written or read; the message names it."""


class TableError(FileError, ValueError):
    """A table that cannot be read or has wrong content; the message names file and line."""


def reason(error: OSError) -> str:
    """Message of the operating system without number and file name, such as ``no space left on device``."""
    text = error.strerror or str(error)
    return text[:1].lower() + text[1:]
