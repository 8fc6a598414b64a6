"""Errors that a command shows to its user as one sentence."""


class UserError(Exception):
    """Something the user can put right; the message says what."""

    status = 2
    """Exit code of a command that ends by it."""


class FileError(UserError, OSError):
    """A file or folder that cannot be written or read; the message names it."""


class TableError(FileError, ValueError):
    """A table that cannot be read, or holds something else; the message names file and line."""


def reason(error: OSError) -> str:
    """The words of the operating system without number and file name, such as ``no space left on device``."""
    text = error.strerror or str(error)
    return text[:1].lower() + text[1:]
